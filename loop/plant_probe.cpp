// SPDX-License-Identifier: MIT
#include "loop/plant_probe.hpp"

#include "notation/long_work.hpp"

namespace mixloop {
namespace {

ActuatorSettings friction_alone(const ActuatorSettings& settings) {
  ActuatorSettings friction;
  friction.viscous = settings.viscous;
  friction.coulomb = settings.coulomb;
  friction.smooth = settings.smooth;
  return friction;
}

}  // namespace

PlantProbe::PlantProbe(const std::shared_ptr<const Scene>& scene, const std::vector<double>& parameters,
                       const ActuatorSettings& actuators, Evaluation how)
    : scene_(scene),
      dynamics_(equations_of(scene, how,
                             {Purpose::forward_dynamics, Purpose::inverse_dynamics, Purpose::linearisation}),
                parameters),
      n_(scene->n()),
      n_u_(scene->n_u()),
      applied_(n_u_),
      slopes_(n_ * (2 * n_ + n_u_)),
      by_psid_(n_u_) {
  if (actuators.has_friction()) friction_.emplace(friction_alone(actuators), static_cast<std::size_t>(n_u_));
}

PlantPose PlantProbe::on_plan(const Plan& plan, std::int64_t k, double rate_hz) {
  const PsiMotion at = whole_motion(scene(), plan.at(k));
  PlantPose pose{static_cast<double>(k) / rate_hz, Vector(2 * n_), Vector(n_)};
  pose.x << at.psi, at.psid;
  dynamics_.evaluate(Purpose::inverse_dynamics,
                     {span_of(at.psi), span_of(at.psid), span_of(at.psidd), pose.t}, span_of(pose.tau));
  pose.tau.conservativeResize(n_u_);
  if (friction_) {  // the drives give that beside what they lose
    const Vector needed = pose.tau;
    pose.tau.setZero();
    drive(pose, pose.x);
    pose.tau = needed - applied_;
  }
  return pose;
}

/// What acts on the mechanism.
void PlantProbe::drive(const PlantPose& pose, const Vector& x) {
  applied_ = pose.tau;
  if (friction_) friction_->add_friction(psid(x), span_of(applied_));
}

void PlantProbe::linearise(const PlantPose& pose, double t, const Vector& x,
                           AccelerationJacobian<double>& jacobian) {
  drive(pose, x);
  dynamics_.evaluate(Purpose::linearisation, {psi(x), psid(x), span_of(applied_), t}, span_of(slopes_));
  jacobian.by_q = Eigen::Map<const Matrix>(slopes_.data(), n_, n_);
  jacobian.by_v = Eigen::Map<const Matrix>(slopes_.data() + n_ * n_, n_, n_);
  if (!friction_) return;
  friction_->friction_slopes(psid(x), span_of(by_psid_));
  const Eigen::Map<const Matrix> by_tau(slopes_.data() + 2 * n_ * n_, n_, n_u_);
  jacobian.by_v.leftCols(n_u_) += by_tau * by_psid_.asDiagonal();
}

Matrix PlantProbe::state_matrix(const PlantPose& pose) {
  work_goes_on();
  AccelerationJacobian<double> jacobian;
  linearise(pose, pose.t, pose.x, jacobian);
  Matrix A = Matrix::Zero(2 * n_, 2 * n_);
  A.topRightCorner(n_, n_).setIdentity();
  A.bottomLeftCorner(n_, n_) = jacobian.by_q;
  A.bottomRightCorner(n_, n_) = jacobian.by_v;
  return A;
}

Vector PlantProbe::advanced(Integrator<>& integrator, const PlantPose& pose, double length) {
  work_goes_on();
  Vector x = pose.x;
  integrator.advance(
      x, length,
      [&](int, int, double after, const Vector& at, Vector& dx) {
        drive(pose, at);
        dx.head(n_) = at.tail(n_);
        dynamics_.evaluate(Purpose::forward_dynamics, {psi(at), psid(at), span_of(applied_), pose.t + after},
                           {dx.data() + n_, static_cast<std::size_t>(n_)});
      },
      [&](double after, const Vector& at, auto& jacobian) { linearise(pose, pose.t + after, at, jacobian); });
  return x;
}

}  // namespace mixloop
