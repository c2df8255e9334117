// SPDX-License-Identifier: MIT
#include "runtime/clock/clock.hpp"

#include <gtest/gtest.h>

namespace mixloop {
namespace {

using namespace std::chrono_literals;

TEST(Pacer, GivesTicksOnAGridThatNeverDrifts) {
  Pacer pacer(3000, 1);
  pacer.start(10s);
  EXPECT_EQ(pacer.due(1), 10s + 333333ns);
  EXPECT_EQ(pacer.due(3), 10s + 1ms);
  EXPECT_EQ(pacer.due(3'000'000'000), 10s + 1'000'000s);
}

TEST(Pacer, RunsAtAMultipleOfRealTime) {
  Pacer pacer(1000, 0.5);
  pacer.start(0s);
  EXPECT_TRUE(pacer.paced());
  EXPECT_EQ(pacer.due(10), 20ms);
  EXPECT_FALSE(Pacer(1000, 0).paced());
}

TEST(Pacer, CatchesUpALittleAndSlipsByMuch) {
  Pacer pacer(1000, 1, 10ms);
  pacer.start(0s);
  pacer.began(5, 5ms + 9ms);
  EXPECT_EQ(pacer.slipped(), 0ns);
  EXPECT_EQ(pacer.due(6), 6ms);
  pacer.began(6, 6ms + 50ms);
  EXPECT_EQ(pacer.slipped(), 50ms);
  EXPECT_EQ(pacer.due(7), 57ms);
}

}  // namespace
}  // namespace mixloop
