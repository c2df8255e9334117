// SPDX-License-Identifier: MIT
// Runs of the paper's experiment, one second of its closed loop each: a sweep's lanes beside its runs one by
// one, both prepared beforehand, and MuJoCo's own Runge-Kutta steps of the same robot, without a controller.
// Interleaved, the best of several rounds; one core.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "bench/engine.hpp"
#include "bench/machine.hpp"
#include "dynamics/program/processor.hpp"
#include "sweep/kernel/closed_loops.hpp"
#include "sweep/sweep.hpp"

namespace mixloop::bench {
namespace {

constexpr int kRuns = 64, kRounds = 15;

template <class Work>
double seconds(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

SweepRequest paper() {
  SweepRequest request;
  request.experiment = MIXLOOP_EXPERIMENTS "/paper.yaml";
  request.design.sampled = {parse_sampled("plant.parameters.payload=uniform(4 kg, 6 kg)")};
  request.design.draws = kRuns;
  return request;
}

/// A thousand of its own steps of 1 ms; none where it isn't installed.
std::function<void()> mujocos_second() {
  Engines engines;
  add_mujoco(engines);
  for (auto& engine : engines)
    if (engine.own_tick)
      return [tick = engine.own_tick] {
        State state{.psi = {0, -16.755, 17.314}};
        for (int k = 0; k < 1000; ++k) tick(state, 1e-3, 1);
      };
  return {};
}

/// What was never measured is not a number, and equal.
bool are_equal(const std::vector<Outcome>& a, const std::vector<Outcome>& b) {
  const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  return std::ranges::equal(a, b, [&](const Outcome& x, const Outcome& y) {
    return x.run == y.run && x.end == y.end && std::ranges::equal(x.values, y.values, same);
  });
}

int run() {
  const Sweep sweep("paper", paper(), Evaluation::machine_code, false);
  std::vector<PreparedRun> runs;
  for (std::int64_t k = 0; k < kRuns; ++k) runs.push_back(sweep.setup().prepared(k));
  const LaneEngine lanes;
  const Telling telling = sweep.telling();
  if (!are_equal(lanes(runs, telling), run_one_by_one(runs, telling))) {
    fmt::print(stderr, "the lanes' outcomes are not those of runs one by one\n");
    return 1;
  }
  const auto mujoco = mujocos_second();
  double alone = HUGE_VAL, beside = HUGE_VAL, peer = HUGE_VAL, prepared = HUGE_VAL;
  for (int round = 0; round < kRounds; ++round) {
    alone = std::min(alone, seconds([&] { run_one_by_one(runs, telling); }) / kRuns);
    beside = std::min(beside, seconds([&] { lanes(runs, telling); }) / kRuns);
    prepared = std::min(prepared, seconds([&] {
                                    for (std::int64_t k = 0; k < kRuns; ++k) sweep.setup().prepared(k);
                                  }) / kRuns);
    if (mujoco) peer = std::min(peer, seconds(mujoco));
  }
  fmt::print(
      "{}, {} lanes\n\n| a run of one second | us | runs a second and core | times the lanes' "
      "|\n|---|---|---|---|\n",
      machine_description(), lane_width());
  const auto line = [&](const char* name, double time) {
    if (time < HUGE_VAL)
      fmt::print("| {} | {:.1f} | {:.0f} | {:.2f} |\n", name, time * 1e6, 1 / time, time / beside);
  };
  line("in lanes", beside);
  line("one by one", alone);
  line("its preparation, beside either", prepared);
  line("MuJoCo's own steps (RK4), no controller", peer);
  return 0;
}

}  // namespace
}  // namespace mixloop::bench

int main() { return mixloop::bench::run(); }
