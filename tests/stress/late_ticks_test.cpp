// SPDX-License-Identifier: MIT
// Ticks past 2^40, 35 years at 1 kHz, in every part that counts them: t_k = k / rate by one division, and
// nothing that is added up or cut off.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "loop/recorder.hpp"
#include "runtime/bus/wire.hpp"
#include "runtime/clock/clock.hpp"
#include "runtime/clock/histogram.hpp"
#include "runtime/clock/plant_time.hpp"
#include "tests/stress/figure.hpp"
#include "tests/stress/routes.hpp"
#include "tests/stress/scenes.hpp"

namespace mixloop::stress {

namespace {

// A plant starts at tick 0, and 2^40 ticks take too long to wait for.
void go_to_tick(Plant& plant, std::int64_t tick) {
  PlantState state = plant.state();
  state.motion.tick = tick;
  plant.put_back(state);
}

constexpr std::int64_t kLate = std::int64_t{1} << 40;

Plant papers_plant(const PlantSettings& settings) {
  const SharedScene scene = papers_robot();
  return {{equations_of(scene, Evaluation::machine_code, {Purpose::forward_dynamics}),
           scene->default_parameters()},
          settings,
          1000,
          scene->home};
}

// A mechanism that knows no time moves by the same bytes at tick 10 and at 2^40 + 10, a command delay of 2.4
// ticks included: the ring of commands keeps its order. The figure counts the ticks that differ.
TEST(LateTicksPlant, GoesOnAsAtFirst) {
  Figure figure("late_ticks_plant", "ticks that differ", 0, 300);
  for (const double delay : {0.0, 0.0024}) {
    Plant early = papers_plant({.command_delay = delay}), late = papers_plant({.command_delay = delay});
    std::mt19937_64 random(1);
    for (int k = 0; k < 150; ++k) {
      // A multiple of the ring's length, 2 and 4, so that the commands on their way stay where they are.
      if (k == 10) go_to_tick(late, late.tick() + kLate);
      const auto tau = uniform(random, 3, 2);
      for (Plant* plant : {&early, &late}) plant->command(tau), plant->advance();
      const bool same = std::equal(early.psi().begin(), early.psi().end(), late.psi().begin()) &&
                        std::equal(early.psid().begin(), early.psid().end(), late.psid().begin()) &&
                        early.work() == late.work();
      figure.look(same ? 0 : 1, [&] { return fmt::format("delay {} s, tick {}", delay, late.tick()); });
    }
  }
}

// A slider of 1 kg under f = 1 N cos(w t), w = 1e-3 1/s, whose place after a second at 2^40 / 1000 s is
// known:
//   x = cos(w t_0) (1 - cos w) / w^2 - sin(w t_0) (w - sin w) / w^2.
// t has a resolution of eps t = 2.4e-7 s there: w t is rounded by 2 u at t_k and 4 u at the stages between,
// so f is off by 2 eps w t at most, and x by half of that after the second. (The fractions by their series.)
TEST(LateTicksTime, IsTheTickOverTheRate) {
  const SharedScene scene = scene_of(
      "motors: {x: linear}\ncoordinates: [q]\nconstraints: {q: x}\ntransforms:\n  - {from: 0, to: slide, s: "
      "q}\n"
      "bodies:\n  - {frame: slide, mass: 1 kg}\n"
      "loads:\n  - {frame: slide, force: [0, 0, \"1 N * cos(0.001 * t / 1 s)\"]}\nend_effector: {frame: "
      "slide, axes: [z]}\n");
  const std::int64_t starts = length(20, 2000);
  const long double w = 0.001;  // the double that the scene has
  Figure figure("late_ticks_time", "eps t w", 1, starts);
  std::mt19937_64 random(1);
  for (std::int64_t i = 0; i < starts; ++i) {
    const std::int64_t k = kLate + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(kLate));
    Plant plant({equations_of(scene, Evaluation::interpreter, {Purpose::forward_dynamics}), {}}, {}, 1000,
                std::vector{0.0});
    go_to_tick(plant, k);
    const std::vector<double> nothing(1, 0.0);
    bool on_time = true;
    for (int j = 0; j < 1000; ++j) {
      on_time = on_time && plant.time() == static_cast<double>(k + j) / 1000;
      plant.command(nothing);
      plant.advance();
    }
    const long double t0 = static_cast<long double>(k) / 1000;
    const long double x =
        std::cos(w * t0) * (0.5L - w * w / 24) - std::sin(w * t0) * (w / 6 - w * w * w / 120);
    const double unit = kEps * static_cast<double>(t0 * w);
    figure.look(on_time ? std::abs(static_cast<double>(plant.psi()[0] - x)) / unit : HUGE_VAL, [&] {
      return fmt::format("tick {}: {:.17g} m instead of {:.17g}", k, plant.psi()[0], static_cast<double>(x));
    });
  }
}

// A plan holds its end for ever, and a recorder its last ticks. The figure counts what differs.
TEST(LateTicksHold, KeepsTheEndOfThePlan) {
  const Experiment experiment = load_experiment(MIXLOOP_EXPERIMENTS "/paper.yaml", {});
  const Plan plan = make_plan(experiment);
  Recorder recorder(experiment, plan);
  Figure figure("late_ticks_hold", "differences", 0, 40);
  const Reference end = plan.at(plan.ticks() + 1);
  const auto expect = [&](bool held, const char* what, std::int64_t k) {
    figure.look(held ? 0 : 1, [&] { return fmt::format("{} at tick {}", what, k); });
  };
  const std::vector<double> tau(3, 0.5);
  for (const std::int64_t k : {kLate - 1, kLate, kLate + 1, 1000 * kLate + 7, std::int64_t{1} << 62}) {
    expect(plan.at(k).psi == end.psi && plan.at(k).position == end.position && plan.at(k).psid.isZero(0),
           "the plan", k);
    expect(plan.at_stage(k, 1).psi == end.psi, "the plan's stage", k);
    expect(recorder.state(k, span_of(end.psi), span_of(end.psid), static_cast<double>(k % 1000)),
           "the recorder's watch", k);
    expect(recorder.command(k, tau, tau), "the recorder's command", k);
    expect(recorder.work(k) == static_cast<double>(k % 1000) && recorder.psi(k)[1] == end.psi[1],
           "the recorder's row", k);
    expect(recorder.time(k) == static_cast<double>(k) / 1000, "the recorder's time", k);
  }
}

/// unit k / rate rounded down, exactly.
std::int64_t floor_of(std::int64_t unit, std::int64_t k, std::int64_t rate) {
  return unit * (k / rate) + unit * (k % rate) / rate;
}

// Messages: ticks up to 2^62 pass the wire, and plant time in us is tick / rate rounded down, to the last us.
TEST(LateTicksWire, CarriesTheTickAndItsMicrosecond) {
  const std::int64_t ticks = length(2000, 2000000);
  Figure figure("late_ticks_wire", "us", 0, 2 * ticks);
  std::mt19937_64 random(1);
  Outbox<state_t> out(3);
  Inbox<state_t> in(3);
  for (std::int64_t i = 0; i < ticks; ++i) {
    const std::int64_t k =
        static_cast<std::int64_t>(random() >> (2 + random() % 40)) & ((std::int64_t{1} << 52) - 1);
    const auto rate = static_cast<std::int64_t>(1 + random() % 1000000);
    const std::int64_t exact = floor_of(1'000'000, k, rate);
    if (k / rate > std::numeric_limits<std::int64_t>::max() / 1000000) continue;
    figure.look(static_cast<double>(std::abs(plant_time_us(k, static_cast<double>(rate)) - exact)),
                [&] { return fmt::format("tick {} at {} Hz", k, rate); });
    out.message.seq = 1024 * k + 1;
    out.message.utime = exact;
    const bool read = !in.read(out.encode());
    figure.look(read && in.message.seq == 1024 * k + 1 && in.message.utime == exact ? 0 : HUGE_VAL,
                [&] { return fmt::format("seq {}", 1024 * k + 1); });
  }
}

// The pacer's due times: one division by the rate, rounded to eps, then to a ns.
TEST(LateTicksPacer, IsOnTimeToItsLastPlace) {
  const std::int64_t ticks = length(2000, 2000000);
  Figure figure("late_ticks_pacer", "eps t + 1 ns", 2, ticks);
  std::mt19937_64 random(1);
  for (std::int64_t i = 0; i < ticks; ++i) {
    const std::int64_t k = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(4 * kLate));
    const auto rate = static_cast<std::int64_t>(1000 + random() % 4000);
    const std::int64_t exact = floor_of(1'000'000'000, k, rate);
    const Pacer pacer(static_cast<double>(rate), 1);
    figure.look(
        static_cast<double>(std::abs(pacer.due(k).count() - exact)) / (1 + kEps * static_cast<double>(exact)),
        [&] { return fmt::format("tick {} at {} Hz", k, rate); });
  }
}

// A histogram of durations up to 2^62 ns keeps its promise of 1/64.
TEST(LateTicksHistogram, KeepsItsPromiseForLongDurations) {
  Figure figure("late_ticks_histogram", "of the duration", Histogram::kRelativeError, 62 * 3);
  for (int e = 0; e < 62; ++e)
    for (const std::int64_t d : {std::int64_t{-1}, std::int64_t{0}, std::int64_t{1}}) {
      const std::int64_t duration =
          std::max<std::int64_t>((std::int64_t{1} << e) + d * ((std::int64_t{1} << e) / 3), 1);
      Histogram histogram;
      histogram.add(std::chrono::nanoseconds(duration));
      histogram.add(std::chrono::nanoseconds(std::numeric_limits<std::int64_t>::max()));
      const auto found = histogram.quantile(0.5).count();
      figure.look(std::abs(static_cast<double>(found - duration)) / static_cast<double>(duration),
                  [&] { return fmt::format("{} ns", duration); });
    }
}

}  // namespace
}  // namespace mixloop::stress
