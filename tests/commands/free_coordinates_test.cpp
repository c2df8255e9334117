// SPDX-License-Identifier: MIT
// Mechanisms with free coordinates by every command and every route.
#include <gmock/gmock.h>

#include <csignal>

#include "tests/support/bad_network.hpp"
#include "tests/support/heard.hpp"
#include "tests/support/refused.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;
using testing::Not;

nlohmann::json told_by(std::vector<std::string> words, const std::vector<std::string>& environment = {},
                       int status = 0) {
  words.insert(words.begin(), bin("mixloop"));
  words.emplace_back("--json");
  Command command(words, environment);
  EXPECT_EQ(command.wait(), status) << command.out() << command.err();
  return command.json();
}

class HeldUprightByCommands : public testing::TestWithParam<const char*> {
 protected:
  std::string file() const { return experiment(GetParam()); }
};

TEST_P(HeldUprightByCommands, HasTheSameBytesByEveryRoute) {
  const auto simulation = told_by({"simulate", file()});
  const auto& hash = simulation["trajectory_sha256"];
  EXPECT_EQ(simulation["verdict"], "held");
  EXPECT_EQ(simulation["final_psi"].size(), 2U);
  EXPECT_EQ(simulation["max_torque"].size(), 1U);
  EXPECT_EQ(told_by({"simulate", file(), "--evaluation", "interpreter"})["trajectory_sha256"], hash);
  const auto run = told_by({"run", file()});
  EXPECT_EQ(run["trajectory_sha256"], hash);
  EXPECT_EQ(run["final_psi"], simulation["final_psi"]);
}

TEST_P(HeldUprightByCommands, HasTheSameBytesOnABadNetwork) {
  const std::vector<std::string> shorter = {"--set", "duration=0.5 s", "--set", "expect={}"};
  const auto with = [&](std::vector<std::string> words) {
    words.insert(words.end(), shorter.begin(), shorter.end());
    return words;
  };
  const auto hash = told_by(with({"simulate", file()}))["trajectory_sha256"];
  for (int seed = 1; seed <= 2; ++seed) {
    const auto run = told_by(with({"run", file()}), bad_network(seed));
    EXPECT_EQ(run["trajectory_sha256"], hash) << seed;
    EXPECT_GT(run["resent"], 0);
  }
}

TEST_P(HeldUprightByCommands, IsStable) {
  const auto judged = told_by({"stability", file(), "--no-confirmation"});
  EXPECT_EQ(judged["cases"][0]["verdict"], "stable") << judged.dump(1).substr(0, 2000);
  EXPECT_TRUE(judged["cases"][0]["warnings"].empty());
}

TEST_P(HeldUprightByCommands, IsKeptReportedReplayedAndShown) {
  const ScratchFolder folder;
  const std::string out = folder.file("kept");
  const std::vector<std::string> shorter = {"--set", "duration=0.3 s", "--set", "expect={}"};
  std::vector<std::string> words = {"run", file(), "--truth", "--out", out};
  words.insert(words.end(), shorter.begin(), shorter.end());
  told_by(words);
  const std::string table = bytes_of(out + "/trajectory.csv");
  EXPECT_THAT(table.substr(0, table.find('\n')), HasSubstr("psi_2,psid_1,psid_2,tau_1,tau_applied_1"));
  words = {"replay", file(), out + "/run.lcmlog"};
  words.insert(words.end(), shorter.begin(), shorter.end());
  const auto replayed = told_by(words);
  EXPECT_EQ(replayed["identical"], replayed["commands"]) << "a listener may miss one of 301";
  EXPECT_GT(replayed["identical"], 290);
  if (!MIXLOOP_HAS_PAGES) GTEST_SKIP() << "built without npm";
  told_by({"report", out, "--out", folder.file("report.html")});
  EXPECT_THAT(bytes_of(folder.file("report.html")), HasSubstr("\"free\":[{\"name\":"));
  std::filesystem::remove(out + "/result.json");
  told_by({"report", out + "/run.lcmlog", "--out", folder.file("log.html")});
  for (const std::string& what : {out + "/run.lcmlog", file()}) {
    Command view({bin("mixloop"), "view", what, "--port", "0", "--json"});
    EXPECT_TRUE(eventually([&] { return view.out().ends_with("}\n"); })) << view.err();
    view.signal(SIGINT);
    EXPECT_EQ(view.wait(), 0) << view.err();
  }
}

TEST_P(HeldUprightByCommands, IsMonitored) {
  Command monitor({bin("mixloop"), "monitor", "--json", "--seconds", "2", "--patience", "60", file()});
  ASSERT_TRUE(eventually([] { return listeners() >= 1; }));
  Command run({bin("mixloop"), "run", file(), "--truth", "--hold", "--speed", "1"});
  ASSERT_EQ(monitor.wait(), 0) << monitor.err();
  const auto seen = monitor.json();
  EXPECT_EQ(seen["condition"], "moving") << seen.dump(1);
  EXPECT_EQ(seen["torque"].size(), 1U);
  EXPECT_GT(seen["channels"]["MIXLOOP_TRUTH"]["received"], 0);
  EXPECT_EQ(seen["channels"]["MIXLOOP_TRUTH"]["bad"], 0);
  run.signal(SIGINT);
  run.wait();
}

INSTANTIATE_TEST_SUITE_P(Shipped, HeldUprightByCommands, testing::Values("cart_pole", "furuta_pendulum"),
                         [](const auto& tested) { return std::string(tested.param); });

/// The cart alone is held; nobody looks at the pole.
const std::vector<std::string> kUnmeasured = {"--set", "controller.gain=[[50, 0, 20, 0]]",
                                              "--set", "plant.sensors={free: []}",
                                              "--set", "plant.initial=[0 m, 170 deg]",
                                              "--set", "duration=0.5 s",
                                              "--set", "expect={}"};

std::vector<std::string> unmeasured(std::vector<std::string> words) {
  words.insert(words.end(), kUnmeasured.begin(), kUnmeasured.end());
  return words;
}

// STATE has one number, and TRUTH two.
TEST(UnmeasuredPole, IsInTruthAlone) {
  const ScratchFolder folder;
  const std::string out = folder.file("kept");
  const auto hash = told_by(unmeasured({"simulate", experiment("cart_pole")}))["trajectory_sha256"];
  EXPECT_EQ(told_by(unmeasured({"run", experiment("cart_pole")}), bad_network(1))["trajectory_sha256"], hash);
  const auto run = told_by(unmeasured({"run", experiment("cart_pole"), "--truth", "--out", out}));
  EXPECT_EQ(run["trajectory_sha256"], hash);
  told_by({"export", out + "/run.lcmlog", "--out", folder.file("csv")});
  const auto head = [&](const char* channel) {
    const std::string csv = bytes_of(folder.file("csv") + "/MIXLOOP_" + channel + ".csv");
    return csv.substr(0, csv.find('\n'));
  };
  EXPECT_THAT(head("STATE"), Not(HasSubstr("psi_measured_2")));
  EXPECT_THAT(head("TRUTH"), HasSubstr("psi_2"));
  const auto replayed = told_by(unmeasured({"replay", experiment("cart_pole"), out + "/run.lcmlog"}));
  EXPECT_EQ(replayed["identical"], replayed["commands"]);
  if (!MIXLOOP_HAS_PAGES) GTEST_SKIP() << "built without npm";
  std::filesystem::remove(out + "/result.json");
  told_by({"report", out + "/run.lcmlog", "--out", folder.file("log.html")});
}

TEST(UnmeasuredPole, IsNoneToDrawOrJudgeByStateAlone) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"track", experiment("cart_pole"), "--attach"},
        std::vector<std::string>{"view", experiment("cart_pole"), "--port", "0"}}) {
    if (words[0] == "view" && !MIXLOOP_HAS_PAGES) continue;
    const auto refused = told_by(unmeasured(words), {}, 2);
    EXPECT_THAT(refused.dump(), HasSubstr("not_measured"));
  }
}

TEST(LinearPlantByCommand, HasAGainThatHoldsIt) {
  const auto linear =
      told_by({"stability", experiment("cart_pole"), "--linear", "--regulator", "5000,100,0,0"});
  EXPECT_NEAR(linear["A"][2][1], 2.6727, 5e-5);
  EXPECT_NEAR(linear["B"][3][0], 4.5455, 5e-5);
  EXPECT_EQ(linear["coordinates"], nlohmann::json::array({"cart", "pole"}));
  EXPECT_EQ(linear["n_motors"], 1);
  EXPECT_TRUE(linear["warnings"].empty());
  EXPECT_NEAR(linear["gain"][0][0], -70.7107, 4);
  const auto held =
      told_by({"simulate", experiment("cart_pole"), "--set", "controller.gain=" + linear["gain"].dump(),
               "--set", "expect={final: [0 m, 0 rad], tolerance: [1e-5 m, 1e-4 rad]}"});
  EXPECT_EQ(held["verdict"], "held");
}

TEST(LinearPlantByCommand, SaysWhereAPoseIsNoneToStayIn) {
  const auto linear = told_by({"stability", experiment("cart_pole"), "--linear", "--psi", "0, 90 deg"});
  EXPECT_NEAR(linear["free_torque"][0], -0.2 * 9.8 * 0.3, 1e-12);
  EXPECT_THAT(linear["warnings"][0], HasSubstr("the free coordinates don't stay so: that would take"));
}

TEST(LinearPlantByCommand, RefusesWeightsThatDoNotFit) {
  const auto refused = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"stability", experiment("cart_pole"), "--linear"});
    return told_by(more, {}, 2)["error"]["message"].get<std::string>();
  };
  EXPECT_THAT(refused({"--regulator", "1,2,3"}), HasSubstr("3 weights; expected one for all, or 4"));
  EXPECT_THAT(refused({"--regulator", "1,2,3,-4"}), HasSubstr("a weight of -4"));
  EXPECT_THAT(refused({"--regulator", "1", "--torque-weights", "0"}), HasSubstr("a weight of 0"));
  EXPECT_THAT(refused({"--psi", "1"}), HasSubstr("each of the 2 coordinates"));
}

}  // namespace
}  // namespace mixloop
