// SPDX-License-Identifier: MIT
#include "runtime/protocol/conductor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace mixloop {
namespace {

constexpr int kAxes = 3;
constexpr std::int64_t kSession = 77;

std::optional<Reject> told(Conductor& conductor, std::int8_t action, std::int64_t seq = 0, double speed = 0,
                           std::int64_t session = kSession) {
  Outbox<sim_control_t> message(kAxes);
  set_header(message.message, {.n = kAxes, .seq = seq, .session = session});
  message.message.action = action;
  message.message.speed = speed;
  return conductor.hear(message.encode());
}

TEST(Conductor, LetsAllGoUntilItIsPaused) {
  Conductor conductor(kAxes, kSession, false);
  EXPECT_TRUE(conductor.lets_go());
  EXPECT_EQ(told(conductor, sim_control_t::ACTION_PAUSE), std::nullopt);
  EXPECT_FALSE(conductor.lets_go());
  EXPECT_EQ(told(conductor, sim_control_t::ACTION_RESUME), std::nullopt);
  EXPECT_TRUE(conductor.lets_go());
  EXPECT_TRUE(conductor.lets_go());
}

TEST(Conductor, StepsAsManyTicksAsAreAskedFor) {
  Conductor conductor(kAxes, kSession, true);
  EXPECT_FALSE(conductor.lets_go());
  told(conductor, sim_control_t::ACTION_STEP, 2);
  told(conductor, sim_control_t::ACTION_STEP, 1);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(conductor.lets_go()) << i;
  EXPECT_FALSE(conductor.lets_go());
  told(conductor, sim_control_t::ACTION_STEP, 5);
  told(conductor, sim_control_t::ACTION_RESUME);
  told(conductor, sim_control_t::ACTION_PAUSE);
  EXPECT_FALSE(conductor.lets_go()) << "steps outlived the pause";
}

TEST(Conductor, GivesANewSpeedOnce) {
  Conductor conductor(kAxes, kSession, false);
  told(conductor, sim_control_t::ACTION_SPEED, 0, 0.5);
  EXPECT_EQ(conductor.new_speed(), 0.5);
  EXPECT_EQ(conductor.new_speed(), std::nullopt);
}

TEST(Conductor, HasNoSpeedThatNoClockCanKeep) {
  Conductor lockstep(kAxes, kSession, false), real_time(kAxes, kSession, false, true);
  EXPECT_EQ(told(lockstep, sim_control_t::ACTION_SPEED, 0, 0), std::nullopt);
  EXPECT_EQ(told(real_time, sim_control_t::ACTION_SPEED, 0, 0), Reject::tick);
  EXPECT_EQ(told(lockstep, sim_control_t::ACTION_SPEED, 0, 1e-300), Reject::tick);
  EXPECT_EQ(real_time.new_speed(), std::nullopt);
  EXPECT_THAT(real_time.objection(), testing::HasSubstr("there is no 'max'"));
  EXPECT_THAT(lockstep.objection(), testing::HasSubstr("expected 1e-6 or more"));
}

TEST(Conductor, DropsWhatIsNotForIt) {
  Conductor conductor(kAxes, kSession, false);
  EXPECT_EQ(told(conductor, sim_control_t::ACTION_PAUSE, 0, 0, kSession + 1), Reject::session);
  EXPECT_EQ(told(conductor, sim_control_t::ACTION_STEP, 0), Reject::tick);
  EXPECT_EQ(told(conductor, sim_control_t::ACTION_STEP, std::numeric_limits<std::int64_t>::max()),
            Reject::tick);
  EXPECT_EQ(told(conductor, sim_control_t::ACTION_SPEED, 0, -1), Reject::tick);
  EXPECT_EQ(told(conductor, sim_control_t::ACTION_SPEED, 0, std::numeric_limits<double>::infinity()),
            Reject::not_finite);
  EXPECT_EQ(told(conductor, sim_control_t::ACTION_END), std::nullopt) << "the plant's own";
  EXPECT_FALSE(conductor.paused());
  EXPECT_FALSE(conductor.reset_asked());
  EXPECT_EQ(conductor.new_speed(), std::nullopt);
  EXPECT_EQ(told(conductor, sim_control_t::ACTION_RESET), std::nullopt);
  EXPECT_TRUE(conductor.reset_asked());
}

}  // namespace
}  // namespace mixloop
