// SPDX-License-Identifier: MIT
// mixloop-planner: publishes the REFERENCE of each tick one tick ahead of the plant.
#include "notation/long_work.hpp"
#include "processes/bus_line.hpp"
#include "processes/peer.hpp"
#include "runtime/protocol/planner_peer.hpp"

namespace mixloop {
namespace {

void fill(const Reference& reference, reference_t& message) {
  const auto copy = [](const auto& from, auto& to) { std::copy(from.begin(), from.end(), std::begin(to)); };
  copy(reference.psi, message.psi_desired);
  copy(reference.psid, message.psid_desired);
  copy(reference.psidd, message.psidd_desired);
  copy(reference.position, message.position_desired);
  copy(reference.velocity, message.velocity_desired);
  copy(reference.acceleration, message.acceleration_desired);
}

int run(const PeerLine& line) {
  StopSwitch stop;
  stop.turn_on_signals();
  const WorkWatch watch([&] { return stop.turned(); });
  const Experiment experiment = line.load();
  if (!experiment.has_path())
    throw InputError(
        "no_path", experiment.path.place,
        "the experiment has a duration in place of a path, and nothing to plan: plant and controller "
        "go without a planner");
  const Plan plan = make_plan(experiment);

  Bus bus(line.bus);
  PlannerSide side;
  side.refer = [&](std::int64_t k, reference_t& message) {
    fill(plan.at(k), message);
    message.phase = k < plan.start_tick() ? reference_t::PHASE_MOVE_TO_START
                    : k > plan.ticks()    ? reference_t::PHASE_HOLD
                                          : reference_t::PHASE_PATH;
  };
  PlannerPeer peer(bus, stop, peer_options(line, experiment, plan.ticks(), "mixloop-planner"),
                   std::move(side));
  // A state wakes controller and planner at once, and only the controller's answer is waited for.
  line.take_rights("mixloop-planner", line.session == 0, 1);
  if (line.session == 0) line.say_waiting("mixloop-planner", "a plant", "STATE");
  return ended("mixloop-planner", peer.run(), peer.report(), stop);
}

}  // namespace
}  // namespace mixloop

int main(int argc, char** argv) {
  return mixloop::peer_main(
      argc, argv, "mixloop-planner: the references of an experiment's path, on the LCM bus.",
      "Checks the whole path first (reach, singularities, branches, limits) and refuses it "
      "with exit status 2 before anything moves.",
      mixloop::run);
}
