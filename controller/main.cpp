// SPDX-License-Identifier: MIT
// mixloop-controller: answers the plant's STATE and the planner's REFERENCE of a tick with its COMMAND.
#include "loop/simulate.hpp"
#include "runtime/controller_peer.hpp"
#include "tools/bus_line.hpp"
#include "tools/peer.hpp"

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

ControllerSide side_of(GuardedController& controller, const Experiment& experiment, const Plan& plan) {
  ControllerSide side;
  side.begin = [&](const state_t& first) {
    controller.begin();
    if (first.seq == 0) require_start(controller, first.psi_measured, plan);
  };
  side.compute = [&](const state_t& state, const reference_t& desired, std::span<double> tau) {
    const double t = static_cast<double>(state.seq) / experiment.rate_hz;
    const bool stale = (state.flags & state_t::FLAG_STALE) != 0;
    return flags_of(
        controller.torque(state.psi_measured, state.psid_measured, stale, reference_in(desired), t, tau));
  };
  side.safe = [&](std::span<double> tau) { controller.safe_torque(tau); };
  return side;
}

int run(const PeerLine& line) {
  StopSwitch stop;
  stop.turn_on_signals();
  const Experiment experiment = line.load();
  const Plan plan = make_plan(experiment);
  GuardedController controller = make_guarded_controller(experiment);

  Bus bus(line.bus);
  ControllerPeer peer(bus, stop, peer_options(line, experiment, plan.ticks()),
                      side_of(controller, experiment, plan));
  line.take_rights("mixloop-controller", line.session == 0);
  return ended("mixloop-controller", peer.run(), peer.report(), stop);
}

}  // namespace
}  // namespace mixloop

int main(int argc, char** argv) {
  return mixloop::peer_main(
      argc, argv, "mixloop-controller: the control law of an experiment, on the LCM bus.",
      "Holds STATE(k) until REFERENCE(k) is there and answers with COMMAND(k); the same "
      "tick always has the same answer.",
      mixloop::run);
}
