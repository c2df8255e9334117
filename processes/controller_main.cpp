// SPDX-License-Identifier: MIT
// mixloop-controller: answers the plant's STATE and the planner's REFERENCE of a tick with its COMMAND.
#include "notation/long_work.hpp"
#include "processes/bus_line.hpp"
#include "processes/controller_side.hpp"
#include "processes/peer.hpp"
#include "runtime/protocol/controller_peer.hpp"

namespace mixloop {
namespace {

int run(const PeerLine& line) {
  StopSwitch stop;
  stop.turn_on_signals();
  const WorkWatch watch([&] { return stop.turned(); });
  const Experiment experiment = line.load();
  const Plan plan = make_plan(experiment);
  GuardedController controller = make_guarded_controller(experiment);
  say_complaint(controller.law().equations().complaint());

  Bus bus(line.bus);
  ControllerPeer peer(bus, stop, peer_options(line, experiment, plan.ticks(), "mixloop-controller"),
                      controller_side(controller, experiment, plan));
  line.take_rights("mixloop-controller", line.session == 0);
  if (line.session == 0) line.say_waiting("mixloop-controller", "a plant", "STATE");
  return ended("mixloop-controller", peer.run(), peer.report(), stop);
}

}  // namespace
}  // namespace mixloop

int main(int argc, char** argv) {
  return mixloop::peer_main(
      argc, argv, "mixloop-controller: the control law of an experiment, on the LCM bus.",
      "Holds STATE(k) until REFERENCE(k) is there (without a path it awaits none) and answers with "
      "COMMAND(k); the same tick always has the same answer.",
      mixloop::run);
}
