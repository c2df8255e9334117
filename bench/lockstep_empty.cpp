// SPDX-License-Identifier: MIT
// The project's lockstep, whole, with nothing to compute: what checks, sessions, resending, statistics and
// the order of REFERENCE before COMMAND cost over lockstep_bare.
//   lockstep_empty [TICKS [N]]
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include "runtime/protocol/controller_peer.hpp"
#include "runtime/protocol/lockstep_plant.hpp"
#include "runtime/protocol/planner_peer.hpp"

namespace {

using namespace mixloop;

struct Nothing final : LockstepSide {
  bool measure(std::int64_t, std::span<double>, std::span<double>) override { return false; }
  bool advance(std::int64_t, std::span<const double>) override { return true; }
  void truth(std::int64_t, truth_t&) override {}
};

pid_t in_child(const std::function<void()>& work) {
  const pid_t child = fork();
  if (child != 0) return child;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  work();
  std::_Exit(0);
}

}  // namespace

int main(int argc, char** argv) {
  const long ticks = argc > 1 ? std::atol(argv[1]) : 5000;
  const int n = argc > 2 ? std::atoi(argv[2]) : 3;
  const StopSwitch stop;

  const pid_t planner = in_child([&] {
    Bus bus;
    PlannerPeer(bus, stop, {.n = n}, {.refer = [](std::int64_t, reference_t&) {}, .begin = {}}).run();
  });
  const pid_t controller = in_child([&] {
    Bus bus;
    ControllerSide side;
    side.compute = [](const state_t&, const reference_t&, std::int64_t, std::span<double>) { return 0; };
    ControllerPeer(bus, stop, {.n = n}, side).run();
  });

  Bus bus;
  Nothing side;
  LockstepPlant plant(bus, stop, {.n = n, .last_tick = ticks}, side);
  plant.run();
  waitpid(planner, nullptr, 0);
  waitpid(controller, nullptr, 0);

  const PlantReport& report = plant.report();
  const auto seconds = [](nanoseconds t) { return std::chrono::duration<double>(t).count(); };
  std::printf(
      R"({"ticks": %ld, "rate": %.1f, "round_trip_p50": %.9f, "round_trip_p99": %.9f, "round_trip_max": %.9f, )"
      R"("resent": %lu})"
      "\n",
      ticks, static_cast<double>(ticks) / seconds(report.wall_time), seconds(report.round_trip.quantile(0.5)),
      seconds(report.round_trip.quantile(0.99)), seconds(report.round_trip.max()), report.resent);
}
