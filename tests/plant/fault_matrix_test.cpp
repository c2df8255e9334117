// SPDX-License-Identifier: MIT
// Every kind of fault in every motor and every sensor of the paper's robot on its path, for 50 ms or for good
// from 0.3 s on: each ends in the state that the table declares.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "loop/result.hpp"
#include "loop/simulate.hpp"

namespace mixloop {
namespace {

constexpr double kHealthyEnd = 11.4529188e-3;  // m: without a fault the error at the end
constexpr double kBound = 20e-3;               // m: held; without a fault the error is 13.2 mm
constexpr double kLimit = 100e-3;              // m: past it, diverged

using enum Verdict;

struct Row {
  const char *target, *lasts, *kind;
  std::array<Verdict, 3> state;  ///< of motor or sensor 1, 2, 3
  const char* reason;

  friend std::ostream& operator<<(std::ostream& out, const Row& row) {
    return out << row.target << ", " << row.lasts << ", " << row.kind << " (" << row.reason << ")";
  }
};

Experiment faulty(const Row& row, int which) {
  const std::string lasting = std::string(row.lasts) == "for good" ? "" : "for: 50 ms, ";
  return load_experiment(
      std::filesystem::path(MIXLOOP_SOURCE) / "experiments/paper.yaml",
      {{"faults", fmt::format("[{{at: 0.3 s, {}{}: {}, kind: {}}}]", lasting, row.target, which, row.kind)},
       {"expect", fmt::format("{{max_position_error: {}}}", kBound)},
       {"limits.position_error", fmt::format("{}", kLimit)}});
}

class FaultMatrix : public testing::TestWithParam<Row> {};

TEST_P(FaultMatrix, EndsInItsDeclaredState) {
  const Row& row = GetParam();
  for (int which = 1; which <= 3; ++which) {
    const Experiment experiment = faulty(row, which);
    const Plan plan = make_plan(experiment);
    RecordedPlant run(experiment, plan);
    simulate(run, [](std::int64_t) { return true; });
    const Measures m = run.recorder().measures();
    const Verdict expected = row.state[static_cast<std::size_t>(which - 1)];
    const std::string seen =
        fmt::format("{} {}: max {:.3f} mm at {:.3f} s, final {:.3f} mm, diverged at {:.3f} s", row.target,
                    which, m.max_position_error * 1e3, m.time_of_max_position_error,
                    m.final_position_error * 1e3, m.diverged_at.value_or(-1));
    EXPECT_EQ(judge(experiment, m).verdict, expected) << seen;
    if (expected == diverged) {
      EXPECT_GE(*m.diverged_at, 0.3) << seen << ": not before the fault";
      continue;
    }
    EXPECT_EQ(m.ticks, 1000) << seen;
    // Healed, the loop forgets at the rate of its slowest poles, Kp / Kv = 50 to 100 1/s: nothing is left at
    // the end.
    if (std::string(row.lasts) == "50 ms") {
      EXPECT_NEAR(m.final_position_error, kHealthyEnd, 0.2e-3) << seen;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Rows, FaultMatrix,
    testing::Values(
        Row{"motor",
            "50 ms",
            "off",
            {held, held, held},
            "what the load moves in 50 ms stays below the bound"},
        Row{"motor",
            "for good",
            "off",
            {diverged, diverged, diverged},
            "nothing carries the load or stops the hand"},
        Row{"motor", "50 ms", "stuck", {held, held, held}, "the torque needed changes little meanwhile"},
        Row{"motor",
            "for good",
            "stuck",
            {diverged, diverged, diverged},
            "a constant torque follows no path"},
        Row{"motor", "50 ms", "garbage, magnitude: 1 N m", {held, held, held}, "as off: its mean is zero"},
        Row{"motor", "for good", "garbage, magnitude: 1 N m", {diverged, diverged, diverged}, "as off"},
        Row{"motor",
            "50 ms",
            "wrong, magnitude: 0.5 N m",
            {held, held, held},
            "0.5 N m / Kp: up to 20 mrad at the motor"},
        Row{"motor",
            "for good",
            "wrong, magnitude: 0.5 N m",
            {held, held, held},
            "which gears of 8 and more make small"},
        Row{"motor",
            "50 ms",
            "slow, magnitude: 1 ms",
            {held, held, held},
            "one motor alone may lag by a tick"},
        Row{"motor",
            "for good",
            "slow, magnitude: 1 ms",
            {held, held, held},
            "one motor alone may lag by a tick"},
        Row{"motor", "50 ms", "slow, magnitude: 20 ms", {held, held, held}, "too short a time to build up"},
        Row{"motor",
            "for good",
            "slow, magnitude: 20 ms",
            {missed, held, held},
            "20 ms is longer than Kv / Kp = 10 ms of motor 1: it swings"},
        Row{"motor", "50 ms", "delayed, magnitude: 5 ms", {held, held, held}, "too short a time to build up"},
        Row{"motor",
            "for good",
            "delayed, magnitude: 5 ms",
            {held, held, diverged},
            "past the longest delay of all three: motor 3 swings itself up in time, 1 and 2 don't"},
        Row{"motor", "50 ms", "intermittent, magnitude: 0.5", {held, held, held}, "half the gains"},
        Row{"motor",
            "for good",
            "intermittent, magnitude: 0.5",
            {held, missed, held},
            "half the gains: twice the error of motor 2, which carries the load"},
        Row{"sensor",
            "50 ms",
            "off",
            {diverged, diverged, diverged},
            "psi jumps to 0, from 2, -6 and 32 rad: Kp asks for 150 to 800 N m"},
        Row{"sensor",
            "50 ms",
            "stuck",
            {diverged, diverged, diverged},
            "a torque that grows with the path, undamped"},
        Row{"sensor", "50 ms", "garbage, magnitude: 0.01 rad", {diverged, diverged, diverged}, "as off"},
        Row{"sensor", "50 ms", "wrong, magnitude: 0.01 rad", {held, held, held}, "10 mrad, geared down"},
        Row{"sensor", "for good", "wrong, magnitude: 0.01 rad", {held, held, held}, "10 mrad, geared down"},
        Row{"sensor",
            "50 ms",
            "wrong, magnitude: 0.5 rad",
            {held, missed, missed},
            "motor 1, the slower one, doesn't get there in 50 ms"},
        Row{"sensor",
            "for good",
            "wrong, magnitude: 0.5 rad",
            {missed, missed, missed},
            "0.5 rad / 8 at up to 0.5 m: some 30 mm"},
        Row{"sensor",
            "50 ms",
            "slow, magnitude: 1 ms",
            {held, held, held},
            "one sensor alone may lag by a tick"},
        Row{"sensor",
            "for good",
            "slow, magnitude: 1 ms",
            {held, held, held},
            "one sensor alone may lag by a tick"},
        Row{"sensor", "50 ms", "slow, magnitude: 5 ms", {held, held, held}, "too short a time to build up"},
        Row{"sensor",
            "for good",
            "slow, magnitude: 5 ms",
            {held, missed, held},
            "at 90 rad/s it says 0.4 rad too little; of motor 3 too, but against the error that there is"},
        Row{"sensor",
            "50 ms",
            "delayed, magnitude: 1 ms",
            {held, held, held},
            "one sensor alone may be a tick late"},
        Row{"sensor",
            "for good",
            "delayed, magnitude: 1 ms",
            {held, held, held},
            "one sensor alone may be a tick late"},
        Row{"sensor",
            "50 ms",
            "delayed, magnitude: 20 ms",
            {diverged, missed, missed},
            "as stuck, for 20 ms"},
        Row{"sensor",
            "for good",
            "delayed, magnitude: 20 ms",
            {diverged, diverged, diverged},
            "past the longest delay"},
        Row{"sensor",
            "50 ms",
            "intermittent, magnitude: 0.5",
            {diverged, diverged, diverged},
            "as off half of the time"},
        Row{"sensor",
            "50 ms",
            "intermittent, magnitude: 0.1",
            {missed, held, diverged},
            "a kick of Kp psi in a few ticks: 220, 150 and 800 N m"},
        Row{"sensor",
            "for good",
            "intermittent, magnitude: 0.1",
            {diverged, diverged, diverged},
            "one kick after another"}));

// What changes in the plant while the controller goes on knowing the old one. The drives have friction, of up
// to 0.01 N m s times 90 rad/s.
struct Change {
  const char *lasts, *change;
  Verdict state;
  double final_error;  ///< m: at least so much is left at the end
  const char* reason;

  friend std::ostream& operator<<(std::ostream& out, const Change& row) {
    return out << row.lasts << ", " << row.change << " (" << row.reason << ")";
  }
};

class ChangeMatrix : public testing::TestWithParam<Change> {};

TEST_P(ChangeMatrix, EndsInItsDeclaredState) {
  const Change& row = GetParam();
  const bool heals = std::string(row.lasts) == "50 ms";
  const Experiment experiment = load_experiment(
      std::filesystem::path(MIXLOOP_SOURCE) / "experiments/paper.yaml",
      {{"plant.actuators", "{friction: {viscous: 0.01 N m s, coulomb: 0.05 N m, smooth: 0.1 rad/s}}"},
       {"faults", fmt::format("[{{at: 0.3 s, {}{}}}]", heals ? "for: 50 ms, " : "", row.change)},
       {"expect", fmt::format("{{max_position_error: {}}}", kBound)},
       {"limits.position_error", fmt::format("{}", kLimit)}});
  const Plan plan = make_plan(experiment);
  RecordedPlant run(experiment, plan);
  simulate(run, [](std::int64_t) { return true; });
  const Measures m = run.recorder().measures();
  EXPECT_EQ(judge(experiment, m).verdict, row.state) << 1e3 * m.max_position_error << " mm";
  EXPECT_EQ(m.ticks, 1000);
  if (heals) {
    EXPECT_NEAR(m.final_position_error, kHealthyEnd, 0.2e-3);
  } else {
    EXPECT_GE(m.final_position_error, row.final_error);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Rows, ChangeMatrix,
    testing::Values(
        Change{"50 ms", "parameter: payload, value: 0 kg", held, 0,
               "dropped and caught again: the hand hardly moves in 50 ms"},
        Change{"50 ms", "parameter: payload, value: 20 kg", held, 0,
               "four times the load for too short a time"},
        Change{"for good", "parameter: payload, value: 0 kg", held, 0, "dropped: Kp no longer carries it"},
        Change{"for good", "parameter: payload, value: 10 kg", missed, 20e-3,
               "picked up: twice the load on Kp, twice the error"},
        Change{"for good", "parameter: payload, value: 20 kg", missed, 40e-3, "four times the load on Kp"},
        Change{"50 ms", "friction: 0", held, 0, "less than 1 N m, geared down"},
        Change{"50 ms", "friction: 30", held, 0, "too short a time to build up"},
        Change{"for good", "friction: 0", held, 0, "less than 1 N m, geared down"},
        Change{"for good", "friction: 10", held, 0, "damps what Kv damps anyway"},
        Change{"for good", "friction: 30", held, 12.5e-3,
               "1.5 N m of Coulomb's hold the motors off their end"}));

}  // namespace
}  // namespace mixloop
