// SPDX-License-Identifier: MIT
// mixloop-planner: publishes the REFERENCE of each tick one tick ahead of the plant.
#include <fmt/format.h>

#include <cmath>

#include "runtime/planner_peer.hpp"
#include "tools/bus_line.hpp"
#include "tools/peer.hpp"

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

/// A plant that stands elsewhere would be thrown to the first reference.
void require_start(const state_t& first, const Reference& start) {
  constexpr double kNear = 0.02;  // rad or m, of a motor: far above what a sensor errs, far below what throws
  if (first.seq != 0) return;
  for (std::size_t i = 0; i < first.psi_measured.size(); ++i) {
    const double desired = start.psi[static_cast<Eigen::Index>(i)];
    if (std::abs(first.psi_measured[i] - desired) <= kNear) continue;
    throw RunFault("not_at_start",
                   fmt::format("motor {} of the plant stands at {:.6g}, the references start at {:.6g}; say "
                               "where it stands (plant.initial), so that a move to the start is planned",
                               i + 1, first.psi_measured[i], desired));
  }
}

int run(const PeerLine& line) {
  StopSwitch stop;
  stop.turn_on_signals();
  const Experiment experiment = line.load();
  const Plan plan = make_plan(experiment);

  Bus bus(line.bus);
  PlannerOptions options{peer_options(line, experiment, plan.ticks())};
  options.rate_hz = experiment.rate_hz;
  PlannerSide side;
  side.begin = [&](const state_t& first) { require_start(first, plan.at(0)); };
  side.refer = [&](std::int64_t k, reference_t& message) {
    fill(plan.at(k), message);
    message.phase = k < plan.start_tick() ? reference_t::PHASE_MOVE_TO_START
                    : k > plan.ticks()    ? reference_t::PHASE_HOLD
                                          : reference_t::PHASE_PATH;
  };
  PlannerPeer peer(bus, stop, options, std::move(side));
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
