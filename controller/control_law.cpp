// SPDX-License-Identifier: MIT
#include "controller/control_law.hpp"

namespace mixloop {

Controller::Controller(Equations::Workspace dynamics, ControllerSettings settings)
    : dynamics_(std::move(dynamics)),
      settings_(std::move(settings)),
      model_torque_(settings_.kp.size()),
      at_rest_(Vector::Zero(settings_.kp.size())) {}

void Controller::torque(std::span<const double> psi, std::span<const double> psid, const Reference& reference,
                        double t, std::span<double> tau) {
  const Law law = settings_.law;
  const bool desired = settings_.feedforward_at == FeedforwardAt::desired;
  const std::span<const double> model_psi = desired ? span_of(reference.psi) : psi;
  const std::span<const double> model_psid = desired ? span_of(reference.psid) : psid;
  Eigen::Map<Vector> out(tau.data(), static_cast<Eigen::Index>(tau.size()));

  // (33) tau = Kp (Psi_d - Psi) + Kv (Psi'_d - Psi') + ...
  out = settings_.kp.cwiseProduct(reference.psi - map_of(psi)) +
        settings_.kv.cwiseProduct(reference.psid - map_of(psid));
  if (law == Law::pd_feedforward || law == Law::computed_torque) {
    dynamics_.evaluate(Purpose::mass_times, {.psi = model_psi, .input = span_of(reference.psidd), .t = t},
                       span_of(model_torque_));
    out += model_torque_;
  }
  if (law == Law::pd_gravity || law == Law::computed_torque) {
    const auto rates = law == Law::pd_gravity ? span_of(std::as_const(at_rest_)) : model_psid;
    dynamics_.evaluate(Purpose::bias, {.psi = model_psi, .psid = rates, .t = t}, span_of(model_torque_));
    out += model_torque_;
  }
}

}  // namespace mixloop
