// SPDX-License-Identifier: MIT
// Plant and controller on two hosts, joined by a cable that loses datagrams (tools/two-hosts).
#include <gtest/gtest.h>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

TEST(TwoHosts, GiveTheSimulatedBytesOverALossyCable) {
  Command simulate({bin("mixloop"), "simulate", experiment("paper"), "--json"});
  Command plant({MIXLOOP_SOURCE "/tools/two-hosts", MIXLOOP_BIN, experiment("paper"), "0.02"});
  ASSERT_EQ(simulate.wait(), 0) << simulate.err();
  ASSERT_EQ(plant.wait(), 0) << plant.err();
  EXPECT_EQ(plant.json()["trajectory_sha256"], simulate.json()["trajectory_sha256"]);
  EXPECT_GT(plant.json()["resent"], 0) << "nothing was lost";
}

}  // namespace
}  // namespace mixloop
