// SPDX-License-Identifier: MIT
#include "runtime/protocol/session.hpp"

#include <gtest/gtest.h>

namespace mixloop {
namespace {

using namespace std::chrono_literals;

const Received kState{.sender = {.address = 0x7f000001, .port = 4000}};

TEST(SessionFollower, TakesTheFirstSessionThatItHears) {
  SessionFollower f(0);
  EXPECT_FALSE(f.would_follow(0, 5s)) << "0 is no session";
  EXPECT_TRUE(f.would_follow(7, 5s));
  EXPECT_TRUE(f.follow(7, kState, 5s));
  EXPECT_EQ(f.current(), 7);
  EXPECT_FALSE(f.follow(7, kState, 5s + 1ms)) << "no longer the first";
}

TEST(SessionFollower, TakesAnotherOnlyAfterASecondOfSilence) {
  SessionFollower f(0);
  f.follow(7, kState, 5s);
  EXPECT_FALSE(f.would_follow(8, 6s));
  EXPECT_TRUE(f.would_follow(8, 6s + 1ns));
  f.follow(7, kState, 6s);
  EXPECT_FALSE(f.would_follow(8, 6s + 1ns)) << "7 was heard again";
  EXPECT_TRUE(f.follow(8, kState, 8s));
  EXPECT_FALSE(f.would_follow(7, 8s));
}

TEST(SessionFollower, NeverLeavesAGivenSession) {
  SessionFollower f(7);
  EXPECT_EQ(f.current(), 7);
  EXPECT_FALSE(f.would_follow(8, 100s));
  EXPECT_TRUE(f.follow(7, kState, 100s));
  EXPECT_FALSE(f.would_follow(8, 200s));
}

TEST(Session, DrawnIdsDifferAndAreNotZero) {
  const auto a = draw_session(), b = draw_session();
  EXPECT_NE(a, 0);
  EXPECT_NE(a, b);
}

}  // namespace
}  // namespace mixloop
