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

SweepRequest paper(std::vector<Override> overrides = {}) {
  SweepRequest request;
  request.experiment = MIXLOOP_EXPERIMENTS "/paper.yaml";
  request.overrides = std::move(overrides);
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

/// Runs of one kind, by both ways.
class Kind {
 public:
  Kind(const char* name, const SweepRequest& request)
      : name_(name), sweep_("paper", request, Evaluation::machine_code, false) {
    for (std::int64_t k = 0; k < kRuns; ++k) runs_.push_back(sweep_.setup().prepared(k));
  }

  bool is_equal() const {
    return std::ranges::equal(lanes_(runs_, sweep_.telling()), run_one_by_one(runs_, sweep_.telling()),
                              are_same);
  }
  void go_round() {
    alone = std::min(alone, seconds([&] { run_one_by_one(runs_, sweep_.telling()); }) / kRuns);
    beside = std::min(beside, seconds([&] { lanes_(runs_, sweep_.telling()); }) / kRuns);
  }
  double preparation() const {
    return seconds([&] {
             for (std::int64_t k = 0; k < kRuns; ++k) sweep_.setup().prepared(k);
           }) /
           kRuns;
  }
  const char* name() const { return name_; }

  double alone = HUGE_VAL, beside = HUGE_VAL;  ///< s a run, least so far

 private:
  const char* name_;
  Sweep sweep_;
  LaneEngine lanes_;
  std::vector<PreparedRun> runs_;
};

int run() {
  Kind ideal("ideal", paper());
  Kind sensors("an encoder's noise and steps",
               paper({{"plant.sensors",
                       "{resolution: 1 rev / 16384, noise: 0.005 deg, velocity: differentiated, "
                       "velocity_filter: 200 Hz}"}}));
  Kind lag("drives that lag", paper({{"plant.actuators", "{time_constant: 0.5 ms}"}}));
  Kind drives("drives that lag, ripple and rub",
              paper({{"plant.actuators",
                      "{time_constant: 0.5 ms, ripple: {amplitude: 0.03, per_turn: 12}, friction: "
                      "{viscous: 0.01, coulomb: 0.05}}"}}));
  const std::array kinds = {&ideal, &sensors, &lag, &drives};
  for (const Kind* kind : kinds)
    if (!kind->is_equal()) {
      fmt::print(stderr, "{}: the lanes' outcomes are not those of runs one by one\n", kind->name());
      return 1;
    }
  const auto mujoco = mujocos_second();
  double peer = HUGE_VAL, prepared = HUGE_VAL;
  for (int round = 0; round < kRounds; ++round) {
    for (Kind* kind : kinds) kind->go_round();
    prepared = std::min(prepared, ideal.preparation());
    if (mujoco) peer = std::min(peer, seconds(mujoco));
  }
  fmt::print(
      "{}, {} lanes\n\n| a run of one second | us | runs a second and core | times the lanes' "
      "|\n|---|---|---|---|\n",
      machine_description(), lane_width());
  const auto line = [&](const std::string& name, double time, double beside) {
    if (time < HUGE_VAL)
      fmt::print("| {} | {:.1f} | {:.0f} | {:.2f} |\n", name, time * 1e6, 1 / time, time / beside);
  };
  line("in lanes", ideal.beside, ideal.beside);
  line("one by one", ideal.alone, ideal.beside);
  line("its preparation, beside either", prepared, ideal.beside);
  line("MuJoCo's own steps (RK4), no controller", peer, ideal.beside);
  for (const Kind* kind : {&sensors, &lag, &drives}) {
    line(fmt::format("{}, in lanes", kind->name()), kind->beside, kind->beside);
    line(fmt::format("{}, one by one", kind->name()), kind->alone, kind->beside);
  }
  return 0;
}

}  // namespace
}  // namespace mixloop::bench

int main() { return mixloop::bench::run(); }
