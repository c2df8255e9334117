// SPDX-License-Identifier: MIT
#include "controller/control_law.hpp"

namespace mixloop {

Controller::Controller(Equations::Workspace dynamics, ControllerSettings settings)
    : dynamics_(std::move(dynamics)),
      settings_(std::move(settings)),
      psi_(dynamics_.scene().n()),
      psid_(psi_),
      feedforward_(settings_.kp.size()),
      bias_(psi_) {}

void Controller::torque(const Measurement& now, const Reference& desired, std::span<double> tau) {
  const Law law = settings_.law;
  if (law == Law::torque) return settings_.course.at(now.t, tau);
  if (law == Law::state_feedback) return feed_back(now, desired, tau);
  const auto n_u = settings_.kp.size();
  Eigen::Map<Vector> out(tau.data(), n_u);
  psi_ = map_of(now.psi);
  psid_ = map_of(now.psid);

  // (33) tau = Kp (Psi_d - Psi) + Kv (Psi'_d - Psi') + ..., of the motors
  out = settings_.kp.cwiseProduct(desired.psi - psi_.head(n_u)) +
        settings_.kv.cwiseProduct(desired.psid - psid_.head(n_u));
  // Of the free coordinates nothing is desired: the model takes them as measured.
  if (settings_.feedforward_at == FeedforwardAt::desired) {
    psi_.head(n_u) = desired.psi;
    psid_.head(n_u) = desired.psid;
  }
  if (law == Law::pd_gravity) psid_.setZero();
  if (law == Law::pd_feedforward || law == Law::computed_torque) {
    dynamics_.evaluate(Purpose::mass_times,
                       {.psi = span_of(std::as_const(psi_)), .input = span_of(desired.psidd), .t = now.t},
                       span_of(feedforward_));
    out += feedforward_;
  }
  if (law == Law::pd_gravity || law == Law::computed_torque) {
    dynamics_.evaluate(
        Purpose::bias,
        {.psi = span_of(std::as_const(psi_)), .psid = span_of(std::as_const(psid_)), .t = now.t},
        span_of(bias_));
    out += bias_.head(n_u);
  }
}

/// tau = tau_0 - K (x - x_0), x_0 of the motors their reference.
void Controller::feed_back(const Measurement& now, const Reference& desired, std::span<double> tau) {
  const auto n_u = settings_.about_torque.size();
  psi_ = map_of(now.psi) - settings_.about_psi;
  psid_ = map_of(now.psid) - settings_.about_psid;
  psi_.head(n_u) = map_of(now.psi).head(n_u) - desired.psi;
  psid_.head(n_u) = map_of(now.psid).head(n_u) - desired.psid;
  for (Eigen::Index i = 0; i < n_u; ++i) {
    double torque = settings_.about_torque[i];
    for (Eigen::Index j = 0; j < psi_.size(); ++j)
      torque -= settings_.gain(i, j) * psi_[j] + settings_.gain(i, psi_.size() + j) * psid_[j];
    tau[static_cast<std::size_t>(i)] = torque;
  }
}

}  // namespace mixloop
