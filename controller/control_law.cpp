// SPDX-License-Identifier: MIT
#include "controller/control_law.hpp"

namespace mixloop {

Controller::Controller(Equations::Workspace dynamics, ControllerSettings settings, std::vector<int> seen)
    : dynamics_(std::move(dynamics)),
      settings_(std::move(settings)),
      seen_(std::move(seen)),
      psi_(settings_.law == Law::state_feedback ? settings_.about_psi.size() : dynamics_.scene().n()),
      psid_(psi_),
      feedforward_(settings_.kp.size()),
      bias_(psi_) {
  if (seen_.empty())
    for (int i = 0; i < psi_.size(); ++i) seen_.push_back(i);
}

/// What isn't measured is left at 0: no law takes it.
void Controller::take(const Measurement& now) {
  for (Eigen::Index i = 0; i < psi_.size(); ++i) {
    const int at = seen_[static_cast<std::size_t>(i)];
    psi_[i] = at < 0 ? 0 : now.psi[static_cast<std::size_t>(at)];
    psid_[i] = at < 0 ? 0 : now.psid[static_cast<std::size_t>(at)];
  }
}

void Controller::torque(const Measurement& now, const Reference& desired, std::span<double> tau) {
  const Law law = settings_.law;
  if (law == Law::torque) return settings_.course.at(now.t, tau);
  if (law == Law::state_feedback) return feed_back(now, desired, tau);
  const auto n_u = settings_.kp.size();
  Eigen::Map<Vector> out(tau.data(), n_u);
  take(now);

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
  take(now);
  psi_.head(n_u) -= desired.psi;
  psid_.head(n_u) -= desired.psid;
  psi_.tail(psi_.size() - n_u) -= settings_.about_psi.tail(psi_.size() - n_u);
  psid_.tail(psi_.size() - n_u) -= settings_.about_psid.tail(psi_.size() - n_u);
  for (Eigen::Index i = 0; i < n_u; ++i) {
    double torque = settings_.about_torque[i];
    for (Eigen::Index j = 0; j < psi_.size(); ++j)
      torque -= settings_.gain(i, j) * psi_[j] + settings_.gain(i, psi_.size() + j) * psid_[j];
    tau[static_cast<std::size_t>(i)] = torque;
  }
}

}  // namespace mixloop
