// SPDX-License-Identifier: MIT
// mixloop-controller: answers the plant's STATE and the planner's REFERENCE of a tick with its COMMAND.
#include <fmt/format.h>

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

int run(const PeerLine& line) {
  StopSwitch stop;
  stop.turn_on_signals();
  const Experiment experiment = line.load();
  const Plan plan = make_plan(experiment);
  Controller controller = make_controller(experiment);

  Bus bus(line.bus);
  ControllerSide side;
  side.compute = [&](std::int64_t k, std::span<const double> psi, std::span<const double> psid,
                     const reference_t& desired, std::span<double> tau) {
    controller.torque(psi, psid, reference_in(desired), static_cast<double>(k) / experiment.rate_hz, tau);
  };
  ControllerPeer peer(bus, stop, peer_options(line, experiment, plan.ticks()), std::move(side));
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
