// SPDX-License-Identifier: MIT
// The paper's robot under commands with a deadline.
#include "plant/deadline_plant.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "loop/experiment.hpp"

namespace mixloop {
namespace {

struct Bench {
  template <class... Text>
  explicit Bench(const Text&... sets)
      : experiment(load_experiment(std::filesystem::path(MIXLOOP_EXPERIMENTS "/paper.yaml"),
                                   {parse_override(sets)...})),
        plan(make_plan(experiment)),
        hardware(make_deadline_plant(experiment, plan)) {}

  /// Holds the start by a PD law for so many ticks, so that there is something to lose.
  void live(std::int64_t ticks) {
    GuardedController controller = make_guarded_controller(experiment);
    for (std::int64_t i = 0; i < ticks; ++i) {
      const std::int64_t k = plant().tick();
      controller.torque({plant().psi(), plant().psid(), plant().time()}, plan.at(k), span_of(tau));
      hardware.command({.offset = 100'000, .command = k}, span_of(std::as_const(tau)));
      hardware.finish_tick();
    }
  }
  void miss(std::int64_t ticks) {
    for (std::int64_t i = 0; i < ticks; ++i) hardware.finish_tick();
  }
  const Plant& plant() const { return hardware.plant(); }
  double speed() const { return map_of(plant().psid()).norm(); }

  Experiment experiment;
  Plan plan;
  DeadlinePlant hardware;
  Vector tau = Vector::Zero(3);
};

TEST(DeadlinePlant, CountsWhatIsMissed) {
  Bench bench;
  bench.live(50);
  EXPECT_EQ(bench.hardware.missed(), 0);
  EXPECT_EQ(bench.hardware.success_last_100(), 1);
  bench.miss(3);
  bench.live(10);
  bench.miss(7);
  bench.live(30);
  EXPECT_EQ(bench.hardware.missed(), 10);
  EXPECT_EQ(bench.hardware.longest_miss(), 7);
  EXPECT_DOUBLE_EQ(bench.hardware.success_last_100(), 0.9);
  EXPECT_FALSE(bench.hardware.safe());
  EXPECT_EQ(bench.hardware.arrivals().commands.size(), 90U);
}

TEST(DeadlinePlant, KeepsTheTorqueOfTheLastCommandWhileOneIsMissing) {
  Bench bench;
  bench.live(50);
  const Vector last = bench.tau;
  bench.miss(5);
  EXPECT_EQ(map_of(bench.hardware.commanded()), last);
}

TEST(DeadlinePlant, GoesIntoItsSafeStateAfterMaxMissedAndStays) {
  Bench bench("real_time.max_missed=4");
  bench.live(50);
  bench.miss(4);
  EXPECT_FALSE(bench.hardware.safe());
  bench.miss(1);
  ASSERT_TRUE(bench.hardware.safe());
  EXPECT_EQ(bench.hardware.safe()->tick, 55);
  bench.live(20);
  EXPECT_TRUE(bench.hardware.safe());
  EXPECT_NE(map_of(bench.hardware.commanded()), bench.tau) << "a command was obeyed";
}

TEST(DeadlinePlant, HoldsWhereItStood) {
  Bench bench("real_time.safe_state=hold");
  bench.live(400);
  bench.hardware.make_safe("test");
  const Vector stand = map_of(bench.plant().psi());
  bench.miss(5000);
  EXPECT_LT(bench.speed(), 1e-3);
  // At rest tau = Kp (psi_0 - psi) carries the weight: at most 5 N m on the weakest gain, 25 N m/rad.
  EXPECT_LT((map_of(bench.plant().psi()) - stand).cwiseAbs().maxCoeff(), 0.2);
}

TEST(DeadlinePlant, Damps) {
  Bench bench("real_time.safe_state=damp", "scene.gravity=[0, 0, 0]");
  bench.live(400);
  bench.hardware.make_safe("test");
  const double before = bench.speed();
  ASSERT_GT(before, 0.1);
  bench.miss(5000);
  EXPECT_LT(bench.speed(), 1e-3 * before);
}

TEST(DeadlinePlant, LetsGoAtZeroTorque) {
  Bench bench("real_time.safe_state=zero_torque");
  bench.live(100);
  bench.hardware.make_safe("test");
  bench.miss(1);
  EXPECT_EQ(map_of(bench.hardware.commanded()).norm(), 0);
  EXPECT_EQ(map_of(bench.plant().applied()).norm(), 0);
}

TEST(DeadlinePlant, LocksByItsBrake) {
  Bench bench("real_time.safe_state=brake");
  bench.live(400);
  ASSERT_GT(bench.speed(), 0.1);
  bench.hardware.make_safe("test");
  const Vector stand = map_of(bench.plant().psi());
  bench.miss(100);
  EXPECT_EQ(bench.speed(), 0);
  EXPECT_EQ(map_of(bench.plant().psi()), stand);
}

TEST(DeadlinePlant, GoesItsWayWhenCommandsComeLateAndDoubled) {
  Bench bench;
  bench.live(10);
  const std::vector<double> more = {1, 2, 3}, old = {9, 9, 9};
  bench.hardware.finish_tick();
  bench.hardware.command({.offset = 5, .command = 10},
                         more);  // of the tick before: newer than what is in effect
  bench.hardware.command({.offset = 6, .command = 10}, old);  // doubled
  bench.hardware.command({.offset = 7, .command = 4}, old);   // older
  bench.hardware.finish_tick();
  EXPECT_EQ(map_of(bench.hardware.commanded()), map_of(std::span<const double>(more)));
  EXPECT_EQ(bench.hardware.missed(), 2);
}

}  // namespace
}  // namespace mixloop
