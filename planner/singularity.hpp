// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/procedure/procedure.hpp"

namespace mixloop {

/// What no path may take through zero: each of the scene's `singularities`, and the smallest singular value
/// of the end effector's Jacobian (in the Frobenius norm, motors in units of their `motor_scale`, with the
/// determinant's sign). Each is divided by its value at home: 1 there, positive on home's branch.
class SingularityMeasures {
 public:
  /// Below this much of the value at home a path is too near.
  static constexpr double kLeast = 1e-3;

  SingularityMeasures(const Model<double>& model, const Vector& motor_scale);

  std::size_t count() const { return scale_.size(); }
  std::string name(std::size_t measure) const;

  /// count() values, for the motors' psi (n_u).
  void evaluate(const Vector& psi, double t, double* values);
  /// Whether all are positive.
  bool on_home_branch(const Vector& psi, double t);
  /// Where home itself lies in a singularity, its measure is taken relative to its value here instead.
  void adopt_scale(const Vector& psi, double t);

 private:
  void evaluate_raw(const Vector& motors, double t, double* values);
  std::vector<double> largest_about(const Vector& psi);
  Eigen::Matrix3d scaled_jacobian();

  const Model<double>& model_;
  int n_u_;
  Workspace<double> ws_;
  Vector motor_scale_;
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
