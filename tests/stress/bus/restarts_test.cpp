// SPDX-License-Identifier: MIT
// Processes that are killed and started again, or suspended, in the middle of a run in real time. Whoever is
// left must neither crash nor hang, no torque may pass its limit, and a reset must bring everything back.
#include <gtest/gtest.h>

#include <csignal>
#include <random>

#include "tests/stress/bus/rig.hpp"
#include "tests/stress/figure.hpp"

namespace mixloop::stress {
namespace {

using namespace std::chrono_literals;

double seconds(nanoseconds time) { return std::chrono::duration<double>(time).count(); }

/// kill -9 of one process and its start, until all run again; false where they don't.
bool killed_and_restarted(BusRig& rig, Part victim) {
  const std::int64_t session = rig.state.session;
  rig.kill(victim);
  if (victim == Part::plant) {
    rig.start(victim);
    return rig.runs_anew(session);  // the peers follow another session once theirs is silent
  }
  const Instant limit = now() + 10s;
  while (!rig.in_safe_state() && now() < limit) rig.listen(2ms);
  const bool safe = rig.in_safe_state();
  rig.start(victim);
  return safe && rig.reset();
}

TEST(Restarts, OfARandomProcessEndInTheSafeStateAndBeginAnew) {
  const auto cycles = length(10, 1000);
  BusRig rig({"--realtime"});
  rig.start_all();
  ASSERT_TRUE(rig.runs_anew(0));

  std::mt19937_64 random(1);
  Figure recovery("restarts", "s to run again", 30, cycles);
  Figure torque("restarts_torque", "of the limit", 1, cycles);
  for (std::int64_t cycle = 0; cycle < cycles; ++cycle) {
    const Part victim = kParts[random() % kParts.size()];
    const auto where = [&] { return "cycle " + std::to_string(cycle) + ", " + name_of(victim); };
    rig.listen(std::chrono::milliseconds(random() % 200));
    const Instant begin = now();
    const bool again = killed_and_restarted(rig, victim);
    recovery.look(again ? seconds(now() - begin) : HUGE_VAL, where);
    torque.look(rig.worst_torque, where);
    recovery.note(std::to_string(rig.held_up) + " sessions held up by the machine itself");
    ASSERT_TRUE(again) << where() << "\n" << rig.describe();
  }
}

// The memory of those who live through it.
TEST(Restarts, LeaveThePlantsMemoryAsItWas) {
  const auto cycles = length(6, 200);
  BusRig rig({"--realtime"});
  rig.start_all();
  ASSERT_TRUE(rig.runs_anew(0));
  Figure growth("restarts_memory", "kB that the plant has grown by", growth_bound(512), cycles);
  std::mt19937_64 random(2);
  long before = 0;
  for (std::int64_t cycle = 0; cycle < cycles; ++cycle) {
    const Part victim = random() % 2 == 0 ? Part::planner : Part::controller;
    rig.listen(20ms);
    ASSERT_TRUE(killed_and_restarted(rig, victim)) << rig.describe();
    if (cycle == 2) before = rig.memory(Part::plant);
    growth.look(before == 0 ? 0 : static_cast<double>(rig.memory(Part::plant) - before),
                [&] { return "cycle " + std::to_string(cycle); });
  }
}

TEST(Suspensions, OfEachProcessEndInTheSafeStateAndBeginAnew) {
  const auto pause = full_length() ? 5000ms : 300ms;
  BusRig rig({"--realtime"});
  rig.start_all();
  ASSERT_TRUE(rig.runs_anew(0));
  Figure recovery("suspensions", "s to run again after the reset", 30,
                  static_cast<std::int64_t>(kParts.size()));
  for (const Part victim : kParts) {
    SCOPED_TRACE(name_of(victim));
    rig.listen(300ms);
    rig.process(victim).signal(SIGSTOP);
    rig.listen(pause);
    EXPECT_TRUE(victim == Part::plant || rig.in_safe_state());
    rig.process(victim).signal(SIGCONT);
    EXPECT_TRUE(rig.until([&] { return rig.in_safe_state(); }, 10s));
    rig.listen(100ms);
    ASSERT_TRUE(rig.all_alive());
    const Instant begin = now();
    const bool again = rig.reset();
    recovery.look(again ? seconds(now() - begin) : HUGE_VAL, [&] { return name_of(victim); });
    EXPECT_LE(rig.worst_torque, 1);
  }
}

}  // namespace
}  // namespace mixloop::stress
