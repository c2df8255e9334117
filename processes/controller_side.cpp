// SPDX-License-Identifier: MIT
#include "processes/controller_side.hpp"

#include <memory>

#include "loop/simulate.hpp"

namespace mixloop {
namespace {

Reference reference_in(const reference_t& message) {
  const auto values = [](const std::vector<double>& x) {
    return Reference::Values(x.data(), static_cast<Eigen::Index>(x.size()));
  };
  return {values(message.psi_desired),
          values(message.psid_desired),
          values(message.psidd_desired),
          Reference::Triple(message.position_desired),
          Reference::Triple(message.velocity_desired),
          Reference::Triple(message.acceleration_desired)};
}

std::int32_t flags_of(const CommandMarks& marks) {
  return (marks.limited ? command_t::FLAG_LIMITED : 0) | (marks.safe ? command_t::FLAG_SAFE : 0);
}

}  // namespace

ControllerSide controller_side(GuardedController& controller, const Experiment& experiment,
                               const Plan& plan) {
  ControllerSide side;
  side.begin = [&](const state_t& first) {
    controller.begin();
    if (first.seq == 0) require_start(controller, first.psi_measured, plan);
  };
  const auto later = std::make_shared<ExtrapolatedReference>(plan.n_u());
  side.compute = [&, later](const state_t& state, const reference_t& message, std::int64_t ahead,
                            std::span<double> tau) {
    const Measurement now{.psi = state.psi_measured,
                          .psid = state.psid_measured,
                          .t = static_cast<double>(state.seq) / experiment.rate_hz,
                          .stale = (state.flags & state_t::FLAG_STALE) != 0};
    const Reference heard = plan.has_path() ? reference_in(message) : plan.at(state.seq);
    const Reference desired =
        ahead == 0 ? heard : later->take(heard, static_cast<double>(ahead) / experiment.rate_hz);
    return flags_of(controller.torque(now, desired, tau));
  };
  side.safe = [&](std::span<double> tau) { controller.safe_torque(tau); };
  return side;
}

}  // namespace mixloop
