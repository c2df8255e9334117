// SPDX-License-Identifier: MIT
// One of the toy loop's three processes, for lockstep_test:
//   toy_process plant|controller|planner LAST_TICK [SESSION [SPEED]]
// Prints one JSON object; exit status as the project's executables have it.
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "notation/errors.hpp"
#include "runtime/protocol/controller_peer.hpp"
#include "runtime/protocol/lockstep_plant.hpp"
#include "runtime/protocol/planner_peer.hpp"
#include "tests/runtime/protocol/toy_loop.hpp"
#include "tests/support/allocation_counter.hpp"

namespace {

using namespace mixloop;

// Counts from tick 100 on, when all start-up is over, to the last tick.
class SteadyState {
 public:
  explicit SteadyState(std::int64_t last_tick) : last_tick_(last_tick) {}
  void at(std::int64_t tick) {
    if (tick == 100) counter_.emplace();
    if (tick == last_tick_ && counter_) {
      allocations_ = counter_->count();
      caller_ = counter_->first_caller();
      counter_.reset();
    }
  }
  std::uint64_t allocations() const { return allocations_; }
  const void* caller() const { return caller_; }

 private:
  std::int64_t last_tick_;
  std::optional<AllocationCounter> counter_;
  std::uint64_t allocations_ = 0;
  const void* caller_ = nullptr;
};

void print_rejects(const Rejects& r, const SteadyState& steady) {
  std::printf(R"(, "rejected": %lu, "stale": %lu, "allocations": %lu, "allocated_by": "%p"})"
              "\n",
              r.total() - r.of(Reject::stale), r.of(Reject::stale), steady.allocations(), steady.caller());
}

class ToyPlant final : public LockstepSide {
 public:
  ToyPlant(SteadyState& steady, std::int64_t last_tick) : steady_(steady) {
    commands.reserve(static_cast<std::size_t>(last_tick + 1) * toy::kN);
  }
  bool measure(std::int64_t tick, std::span<double> psi, std::span<double> psid) override {
    steady_.at(tick);
    toy_.measure(psi, psid);
    return false;
  }
  bool advance(std::int64_t, std::span<const double> tau) override {
    commands.insert(commands.end(), tau.begin(), tau.end());
    toy_.advance(tau);
    return true;
  }
  void truth(std::int64_t, truth_t&) override {}

  std::vector<double> commands;

 private:
  SteadyState& steady_;
  toy::Plant toy_;
};

int run_plant(std::int64_t last_tick, std::int64_t session, double speed) {
  Bus bus;
  StopSwitch stop;
  stop.turn_on_signals();
  SteadyState steady(last_tick);
  ToyPlant side(steady, last_tick);
  LockstepPlant plant(
      bus, stop,
      {.n = toy::kN, .last_tick = last_tick, .speed = speed, .session = session, .config = toy::kConfig},
      side);
  const Ending ending = plant.run();
  const PlantReport& r = plant.report();
  std::printf(R"({"ending": "%s", "digest": "%s", "ticks_done": %ld, "resent": %lu, "joined_late": %lu)",
              name(ending).data(), toy::digest(side.commands).c_str(), r.ticks_done, r.resent, r.joined_late);
  print_rejects(r.rejects, steady);
  return stop.turned() ? 130 : 0;
}

template <class Peer>
int run_peer(const PeerOptions& options, auto side_of) {
  Bus bus;
  StopSwitch stop;
  stop.turn_on_signals();
  SteadyState steady(options.last_tick);
  Peer peer(bus, stop, options, side_of(steady));
  const Ending ending = peer.run();
  const PeerReport& r = peer.report();
  std::printf(R"({"ending": "%s", "answered": %lu, "repeated": %lu, "joined_late": %s)", name(ending).data(),
              r.answered, r.repeated, r.joined_late ? "true" : "false");
  print_rejects(r.rejects, steady);
  return stop.turned() ? 130 : 0;
}

ControllerSide controller_side(SteadyState& steady) {
  ControllerSide side;
  side.compute = [&](const state_t& state, const reference_t& r, std::int64_t, std::span<double> tau) {
    steady.at(state.seq);
    toy::compute(state.psi_measured, state.psid_measured, r, tau);
    return 0;
  };
  return side;
}

PlannerSide planner_side(SteadyState& steady) {
  PlannerSide side;
  side.refer = [&](std::int64_t tick, reference_t& r) {
    steady.at(tick);
    toy::refer(tick, r);
  };
  return side;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 3) return 2;
  const std::string_view role = argv[1];
  const std::int64_t last_tick = std::atoll(argv[2]);
  const std::int64_t session = argc > 3 ? std::atoll(argv[3]) : 0;
  const double speed = argc > 4 ? std::atof(argv[4]) : 0;
  if (role == "plant") return run_plant(last_tick, session, speed);
  const PeerOptions options{.n = toy::kN, .session = session, .config = toy::kConfig, .last_tick = last_tick};
  return role == "controller" ? run_peer<ControllerPeer>(options, controller_side)
                              : run_peer<PlannerPeer>(options, planner_side);
} catch (const mixloop::RunFault& fault) {
  std::fprintf(stderr, "%s: %s\n", fault.code.c_str(), fault.what());
  return 3;
}
