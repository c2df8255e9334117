// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>

#include "dynamics/equations.hpp"
#include "integrators/integrator.hpp"
#include "planner/plan.hpp"
#include "plant/actuators.hpp"

namespace mixloop {

/// A state of a plant, and what its drives are asked for there.
struct PlantPose {
  double t = 0;  ///< s
  Vector x;      ///< 2n: psi, psid
  Vector tau;    ///< n_u
};

/// A plant's equations of motion about states that it is to go through, or went through: those of the
/// mechanism with its loads, and of the drives the friction. What else drives and sensors do is left out.
class PlantProbe {
 public:
  PlantProbe(const std::shared_ptr<const Scene>& scene, const std::vector<double>& parameters,
             const ActuatorSettings& actuators, Evaluation how);

  const Scene& scene() const { return *scene_; }
  const std::shared_ptr<const Scene>& shared_scene() const { return scene_; }
  void set_parameters(std::span<const double> parameters) { dynamics_.set_parameters(parameters); }

  /// Where the plan is at tick k, and what keeps the plant on it.
  PlantPose on_plan(const Plan& plan, std::int64_t k, double rate_hz);

  /// d psi''/d psi, d psi''/d psid at a time and state, what the drives are asked for being held.
  void linearise(const PlantPose& pose, double t, const Vector& x, AccelerationJacobian<double>& jacobian);

  /// The 2n x 2n matrix of x' = A x about a pose.
  Matrix state_matrix(const PlantPose& pose);

  /// Where the plant is `length` s later.
  Vector advanced(Integrator<>& integrator, const PlantPose& pose, double length);

 private:
  void drive(const PlantPose& pose, const Vector& x);
  std::span<const double> psi(const Vector& x) const { return {x.data(), static_cast<std::size_t>(n_)}; }
  std::span<const double> psid(const Vector& x) const {
    return {x.data() + n_, static_cast<std::size_t>(n_)};
  }

  std::shared_ptr<const Scene> scene_;
  Equations::Workspace dynamics_;
  int n_, n_u_;
  std::optional<Actuators> friction_;
  Vector applied_, slopes_, by_psid_;
};

}  // namespace mixloop
