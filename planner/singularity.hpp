// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/procedure/procedure.hpp"
#include "planner/prescription.hpp"

namespace mixloop {

/// What no path may take through zero: each of the scene's `singularities`, and of a path of the end effector
/// the smallest singular value of the Jacobian of what is prescribed (in the Frobenius norm, motors in units
/// of their `motor_scale`, with the determinant's sign where it is square). Each is divided by its value at
/// home: 1 there, positive on home's branch.
class SingularityMeasures {
 public:
  /// Below this much of the value at home a path is too near.
  static constexpr double kLeast = 1e-3;

  /// `held`: motors that don't move on a path of the end effector; none: it is of the motors. Refers to
  /// `model`.
  SingularityMeasures(const Model<double>& model, const Vector& motor_scale,
                      const std::optional<std::vector<int>>& held);
  SingularityMeasures(const SingularityMeasures&) = delete;

  /// Those that the scene names, which are the first.
  std::size_t named() const { return model_.scene->singularities.size(); }
  std::size_t count() const { return scale_.size(); }
  std::string name(std::size_t measure) const;
  /// What the end effector can't do where the measure is zero, nearby: " (...)", or nothing where the scene
  /// names it.
  std::string lost(std::size_t measure, const Vector& psi, double t);

  /// count() values, for the motors' psi (n_u).
  void evaluate(const Vector& psi, double t, double* values);
  /// Whether all are positive.
  bool on_home_branch(const Vector& psi, double t);
  /// Where home itself lies in a singularity, its measure is taken relative to its value here instead.
  void adopt_scale(const Vector& psi, double t);

 private:
  void evaluate_raw(const Vector& motors, double t, double* values);
  std::vector<double> largest_about(const Vector& psi);
  Matrix scaled_jacobian(const Vector& motors, double t);

  const Model<double>& model_;
  int n_u_;
  Workspace<double> ws_;
  Vector motor_scale_;
  HandKinematics hand_;
  std::optional<Prescription> prescription_;
  std::vector<double> scale_, buffer_;
};

/// Where a path comes too near to a singularity.
struct Passage {
  double step = 0;  ///< place along the path
  std::size_t measure = 0;
  double value = 0;      ///< of the measure there
  bool crosses = false;  ///< it changes sign
};

/// The first such place. `samples`: count() measures at each whole step 0, 1, ...; `at(step, values)`
/// evaluates between steps, where a sample shows that it may pass zero, or come below the bound, between two
/// of them.
std::optional<Passage> first_passage(const std::vector<double>& samples, std::size_t measures,
                                     const std::function<void(double step, double* values)>& at);

}  // namespace mixloop
