// SPDX-License-Identifier: MIT
// Motions of every kind of mechanism over the bus: the same bytes, on a bad network too.
#include <gmock/gmock.h>

#include <csignal>

#include "tests/support/bad_network.hpp"
#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

struct Motion {
  const char* name;
  std::vector<std::string> shorter;  ///< what makes it short enough
};

nlohmann::json result_of(const Motion& motion, const char* by,
                         const std::vector<std::string>& environment = {}) {
  std::vector<std::string> words = {bin("mixloop"), by, experiment(motion.name), "--json"};
  for (const auto& entry : motion.shorter) words.insert(words.end(), {"--set", entry});
  Command command(words, environment);
  EXPECT_EQ(command.wait(), 0) << command.out() << command.err();
  return command.json();
}

TEST(EveryMotion, HasTheSameBytesOnABadNetwork) {
  int seed = 0;
  for (const Motion& motion :
       {Motion{"four_bar_turns", {"duration=0.5 s", "expect={}"}}, Motion{"four_bar_path", {"path.repeat=1"}},
        Motion{"slider_crank_closed", {"duration=0.5 s", "expect={}"}},
        Motion{"double_four_bar_closed", {"duration=0.5 s", "expect={}"}}, Motion{"seven_bodies", {}},
        Motion{"planar_3rrr_swing", {"duration=0.3 s", "expect={}"}}, Motion{"delta_circle", {}},
        Motion{"spatial_five_bar_swing", {"duration=0.5 s", "expect={}"}},
        Motion{"four_bar_chain_swing", {"duration=0.3 s", "expect={}"}},
        Motion{"four_bar_rocker_turns", {"duration=0.8 s", "expect={}"}},
        Motion{"kapitza_upright", {"duration=0.5 s", "expect={}"}},
        Motion{"bead_on_hoop", {"duration=0.5 s", "expect={}"}}, Motion{"motor_path", {}},
        Motion{"scara_pick_and_place", {}}, Motion{"palletiser_stacks", {}},
        Motion{"puma_560_seam",
               {"path={via: [{at: [0.6, -0.25, 0], direction: [0, 0.342, -0.9397]}, {at: [0.6, -0.2, 0], "
                "duration: "
                "0.3 s}], redundancy: least_norm}"}}}) {
    SCOPED_TRACE(motion.name);
    const auto alone = result_of(motion, "simulate");
    const auto lossy = result_of(motion, "run", bad_network(++seed));
    EXPECT_EQ(lossy["trajectory_sha256"], alone["trajectory_sha256"]);
    for (const char* measure : {"closure_residual", "closure_condition", "switches", "final_psi",
                                "energy_drift", "max_motor_error", "max_orientation_error"})
      EXPECT_EQ(lossy.value(measure, nlohmann::json()), alone.value(measure, nlohmann::json())) << measure;
    EXPECT_GT(lossy["resent"], 0);
  }
}

// No torque, no reference, and messages with nothing in them.
TEST(MotionWithoutMotors, IsKeptReportedReplayedAndShown) {
  const ScratchFolder folder;
  const std::string out = folder.file("kept"), file = experiment("bead_on_hoop");
  const std::vector<std::string> shorter = {"--set", "duration=0.3 s", "--set", "expect={}"};
  const auto told_by = [&](std::vector<std::string> words) {
    words.insert(words.begin(), bin("mixloop"));
    words.emplace_back("--json");
    Command command(words);
    EXPECT_EQ(command.wait(), 0) << command.out() << command.err();
    return command.json();
  };
  std::vector<std::string> words = {"run", file, "--truth", "--out", out};
  words.insert(words.end(), shorter.begin(), shorter.end());
  const auto run = told_by(words);
  EXPECT_TRUE(run["max_torque"].empty());
  const std::string table = bytes_of(out + "/trajectory.csv");
  EXPECT_THAT(table.substr(0, table.find('\n')), testing::StartsWith("t,psi_1,psid_1,position_x"));
  words = {"replay", file, out + "/run.lcmlog"};
  words.insert(words.end(), shorter.begin(), shorter.end());
  const auto replayed = told_by(words);
  EXPECT_EQ(replayed["identical"], replayed["commands"]) << "a listener may miss one of 301";
  EXPECT_GT(replayed["identical"], 290);
  EXPECT_EQ(told_by({"track", file})["results"].size(), 1U);
  if (!MIXLOOP_HAS_PAGES) GTEST_SKIP() << "built without npm";
  told_by({"report", out, "--out", folder.file("report.html")});
  std::filesystem::remove(out + "/result.json");
  told_by({"report", out + "/run.lcmlog", "--out", folder.file("log.html")});
  for (const std::string& what : {out + "/run.lcmlog", file}) {
    Command view({bin("mixloop"), "view", what, "--port", "0", "--json"});
    EXPECT_TRUE(eventually([&] { return view.out().ends_with("}\n"); })) << view.err();
    view.signal(SIGINT);
    EXPECT_EQ(view.wait(), 0) << view.err();
  }
}

// The motors' coordinates, which messages have, don't say where the others are.
TEST(ClosedMotion, ThatSwitchesCoordinatesIsNotDrawn) {
  Command view({bin("mixloop"), "view", experiment("four_bar_rocker_turns"), "--json", "--port", "0"});
  EXPECT_EQ(view.wait(), 2);
  EXPECT_EQ(view.json()["error"]["code"], "switched_coordinates");
}

}  // namespace
}  // namespace mixloop
