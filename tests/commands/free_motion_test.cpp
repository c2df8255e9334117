// SPDX-License-Identifier: MIT
// Motion without a path by every command and every route.
#include <gmock/gmock.h>

#include <csignal>

#include "tests/support/bad_network.hpp"
#include "tests/support/heard.hpp"
#include "tests/support/refused.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;
using testing::Not;

/// What a command that must succeed says as JSON.
nlohmann::json said_by(std::vector<std::string> words, const std::vector<std::string>& environment = {}) {
  words.insert(words.begin(), bin("mixloop"));
  words.emplace_back("--json");
  Command command(words, environment);
  EXPECT_EQ(command.wait(), 0) << command.out() << command.err();
  return command.json();
}

nlohmann::json shipped_motion(const std::string& name, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = {"simulate", experiment(name)};
  words.insert(words.end(), more.begin(), more.end());
  return said_by(words);
}

TEST(FreeMotion, HasTheSameBytesByEveryRoute) {
  for (const char* name : {"four_bar_swing", "slider_crank_swing", "hold_pose"}) {
    SCOPED_TRACE(name);
    const auto simulation = shipped_motion(name);
    const auto& hash = simulation["trajectory_sha256"];
    EXPECT_EQ(shipped_motion(name, {"--evaluation", "interpreter"})["trajectory_sha256"], hash);
    const auto run = said_by({"run", experiment(name)});
    EXPECT_EQ(run["trajectory_sha256"], hash);
    for (const char* measure : {"final_psi", "energy_drift", "max_torque", "verdict"})
      EXPECT_EQ(run[measure], simulation[measure]) << measure;
  }
}

TEST(FreeMotion, HasTheSameBytesOnABadNetwork) {
  const auto hash = shipped_motion("hold_pose")["trajectory_sha256"];
  for (int seed = 1; seed <= 3; ++seed) {
    const auto run = said_by({"run", experiment("hold_pose")}, bad_network(seed));
    EXPECT_EQ(run["trajectory_sha256"], hash) << seed;
    EXPECT_GT(run["resent"], 0);
  }
}

TEST(FreeMotion, HasWhatThereIsAndNoPositionErrors) {
  const auto result = shipped_motion("slider_crank_swing");
  for (const char* none :
       {"max_position_error", "time_of_max_position_error", "final_position_error", "rms_position_error"})
    EXPECT_FALSE(result.contains(none)) << none;
  EXPECT_NEAR(result["final_psi"][0], 54.333332168308, 1e-9);
  EXPECT_EQ(result["position_units"], nlohmann::json::array({"rad"}));
  EXPECT_LT(result["energy_drift"], 1e-12);
  EXPECT_EQ(result["bounds"][0]["name"], "final_psi");
  EXPECT_EQ(result["bounds"][0]["motor"], 0);
  Command words({bin("mixloop"), "simulate", experiment("slider_crank_swing")});
  ASSERT_EQ(words.wait(), 0);
  EXPECT_THAT(words.out(), testing::AllOf(HasSubstr("final position   theta 54.333332168 rad"),
                                          HasSubstr("energy drift     "), Not(HasSubstr("position error"))));
}

TEST(FreeMotion, IsTrackedAlone) {
  const ScratchFolder folder;
  const std::string junit = folder.file("junit.xml"), last = folder.file("last.json");
  const std::vector<std::string> line = {
      bin("mixloop"), "track", experiment("hold_pose"), experiment("slider_crank_swing"), "--junit", junit,
      "--baseline",   last};
  for (int time = 0; time < 2; ++time) {
    Command track(line);
    EXPECT_EQ(track.wait(), 0) << track.out() << track.err();
    EXPECT_THAT(track.out(),
                testing::ContainsRegex("held +slider_crank_swing +final 54.3333322, energy drift "));
  }
  EXPECT_THAT(bytes_of(junit), testing::AllOf(HasSubstr("energy_drift [1]"), HasSubstr("final_psi[0] [rad]"),
                                              Not(HasSubstr("position_error"))));
  EXPECT_THAT(bytes_of(last), HasSubstr("energy_drift"));
  Command missed({bin("mixloop"), "track", experiment("slider_crank_swing"), "--set", "expect.final=[54]"});
  EXPECT_EQ(missed.wait(), 1);
  EXPECT_THAT(missed.out(),
              HasSubstr("final_psi[0] is 54.3333321683 rad; expected 53.999999999 to 54.000000001 rad"));
}

TEST(FreeMotion, KeepsItsFilesForReportAndView) {
  const ScratchFolder folder;
  const std::string out = folder.file("kept");
  const auto run = said_by({"run", experiment("four_bar_swing"), "--set", "duration=0.5 s", "--set",
                            "expect={}", "--truth", "--out", out});
  const std::string header = bytes_of(out + "/trajectory.csv").substr(0, 400);
  EXPECT_THAT(header.substr(0, header.find('\n')),
              testing::AllOf(testing::StartsWith("t,psi_1,psid_1,tau_1,tau_applied_1,position_x_actual"),
                             testing::EndsWith("kinetic_energy,potential_energy,work")));
  EXPECT_EQ(run["log"]["missing_ticks"], 0);

  Command replay({bin("mixloop"), "replay", experiment("four_bar_swing"), out + "/run.lcmlog", "--set",
                  "duration=0.5 s", "--set", "expect={}", "--json"});
  EXPECT_EQ(replay.wait(), 0) << replay.out() << replay.err();
  EXPECT_EQ(replay.json()["identical"], replay.json()["commands"]);

  const auto exported = said_by({"export", out + "/run.lcmlog", "--out", folder.file("csv")});
  EXPECT_THAT(exported.dump(),
              testing::AllOf(HasSubstr("MIXLOOP_COMMAND"), Not(HasSubstr("MIXLOOP_REFERENCE"))));

  if (!MIXLOOP_HAS_PAGES) GTEST_SKIP() << "built without npm";
  const auto report = said_by({"report", out, "--out", folder.file("report.html")});
  EXPECT_THAT(report.dump(), Not(HasSubstr("REFERENCE")));
  std::filesystem::remove(out + "/result.json");
  const auto of_log = said_by({"report", out + "/run.lcmlog", "--out", folder.file("log.html")});
  EXPECT_THAT(of_log.dump(), Not(HasSubstr("REFERENCE")));
  for (const std::string& what : {out + "/run.lcmlog", experiment("four_bar_swing")}) {
    Command view({bin("mixloop"), "view", what, "--port", "0", "--json"});
    EXPECT_TRUE(eventually([&] { return view.out().ends_with("}\n"); })) << view.err();
    view.signal(SIGINT);
    EXPECT_EQ(view.wait(), 0) << view.err();
  }
}

TEST(FreeMotion, IsWatchedWithoutReferences) {
  for (const bool with_experiment : {true, false}) {
    std::vector<std::string> words = {bin("mixloop"), "monitor", "--json", "--seconds", "3",
                                      "--patience",   "60"};
    if (with_experiment) words.push_back(experiment("hold_pose"));
    Command monitor(words);
    ASSERT_TRUE(eventually([] { return listeners() >= 1; }));
    Command run({bin("mixloop"), "run", experiment("hold_pose"), "--hold", "--speed", "1"});
    ASSERT_EQ(monitor.wait(), 0) << monitor.err();
    const auto seen = monitor.json();
    EXPECT_EQ(seen["condition"], "moving") << seen.dump(1);
    EXPECT_EQ(seen["channels"]["MIXLOOP_REFERENCE"]["received"], 0);
    EXPECT_TRUE(seen["position_error"].is_null());
    EXPECT_TRUE(seen["warnings"].empty()) << seen["warnings"];
    EXPECT_TRUE(eventually([&] { return run.out().find("Going on past the end") != std::string::npos; }))
        << run.out() << run.err();
    run.signal(SIGINT);
    EXPECT_EQ(run.wait(), 0) << run.err();
  }
}

TEST(FreeMotion, IsJudgedByWhoListens) {
  Command track({bin("mixloop"), "track", experiment("hold_pose"), "--attach", "--json"});
  ASSERT_TRUE(eventually([] { return listeners() >= 1; }));
  const auto run = said_by({"run", experiment("hold_pose"), "--speed", "2"});
  EXPECT_EQ(track.wait(), 1) << "a listener isn't told the motors' work" << track.out();
  const auto heard = track.json()["results"][0];
  if (heard["missing_ticks"] == 0) {
    EXPECT_EQ(heard["final_psi"], run["final_psi"]);
  }
  EXPECT_THAT(heard["missed"].dump(), HasSubstr("energy_drift was never measured"));
  EXPECT_TRUE(heard["energy_drift"].is_null());
}

/// A stranger's controller: answers every STATE by a constant torque, and knows nothing else.
class Stranger {
 public:
  explicit Stranger(double torque) : states_(1), commands_(1), torque_(torque) {
    bus_.subscribe<&Stranger::on_state>(bus_.channel("STATE"), this);
    bus_.subscribe<&Stranger::on_control>(bus_.channel("SIM_CONTROL"), this);
  }
  void run() {
    const StopSwitch never;
    for (const Instant until = now() + std::chrono::minutes(1); !ended_ && now() < until;)
      bus_.wait(until, never);
  }

 private:
  void on_state(Bytes bytes) {
    if (states_.read(bytes)) return;
    Header header = header_of(states_.message);
    header.n = 1;
    set_header(commands_.message, header);
    commands_.message.tau_commanded[0] = torque_;
    bus_.publish(bus_.channel("COMMAND"), commands_.encode());
  }
  void on_control(Bytes) { ended_ = true; }

  Bus bus_;
  Inbox<state_t> states_;
  Outbox<command_t> commands_;
  double torque_;
  bool ended_ = false;
};

// Of a link of J = 4 kg m^2 without a weight: theta = tau t^2 / (2 J).
TEST(FreeMotion, MayBeDrivenByAStrangersController) {
  const ScratchFolder folder;
  folder.write("link.yaml",
               "motors: [theta]\ncoordinates: [q]\nconstraints: {q: theta}\n"
               "transforms: [{from: 0, to: bar, theta: q}]\n"
               "bodies: [{frame: bar, mass: 1 kg, inertia: {xx: 4 kg m^2, yy: 4 kg m^2, zz: 4 kg m^2}}]\n");
  const std::string free = folder.write(
      "free.yaml",
      "scene: link.yaml\nduration: 2 s\ncontroller: {law: torque, torque: [0]}\n"
      "expect: {final: [1.5 rad], tolerance: 1e-12 rad, energy_drift: 1e-12, max_torque: [3]}\n");
  Stranger stranger(3);
  Command run({bin("mixloop"), "run", free, "--without", "controller", "--json"});
  stranger.run();
  EXPECT_EQ(run.wait(), 0) << run.out() << run.err();
  EXPECT_EQ(run.json()["verdict"], "held");
  EXPECT_EQ(shipped_motion("hold_pose")["verdict"], "held");
  // A scene without an end effector, and everything that looks at it.
  const std::string scene = folder.file("link.yaml"), out = folder.file("kept");
  EXPECT_FALSE(said_by({"dynamics", scene, "--psi", "1"}).contains("end_effector"));
  said_by({"explain", scene});
  said_by({"simulate", free, "--set", "controller.torque=[3 N m]", "--out", out});
  EXPECT_THAT(bytes_of(out + "/trajectory.csv"), Not(HasSubstr("position")));
  if (MIXLOOP_HAS_PAGES) said_by({"report", out, "--out", folder.file("report.html")});
}

TEST(FreeMotion, HasNoPlanner) {
  Command planner({bin("mixloop-planner"), experiment("hold_pose")});
  EXPECT_EQ(planner.wait(), 2);
  EXPECT_THAT(planner.err(), HasSubstr("nothing to plan: plant and controller go without a planner"));
  expect_refused({"run", experiment("hold_pose"), "--without", "planner"}, 2, "no_path",
                 "no planner to leave out");
  Command lonely(
      {bin("mixloop"), "run", experiment("hold_pose"), "--without", "controller", "--first-wait", "0.5"});
  EXPECT_EQ(lonely.wait(), 3);
  EXPECT_THAT(lonely.err(),
              testing::AllOf(HasSubstr("the controller is missing"), Not(HasSubstr("planner"))));
}

TEST(FreeMotion, IsStableAboutTheStateThatIsFedBackOrNothingIs) {
  const auto held = said_by({"stability", experiment("hold_pose")});
  EXPECT_EQ(held["along"], "state");
  EXPECT_EQ(held["cases"][0]["verdict"], "stable");
  EXPECT_TRUE(held["cases"][0]["warnings"].empty()) << held["cases"][0]["warnings"];
  // The slowest poles near -20 1/s, shifted by gravity's own stiffness.
  EXPECT_NEAR(held["cases"][0]["at_start"]["spectral_radius"].get<double>(), std::exp(-0.013), 1e-3);
  EXPECT_EQ(held["cases"][0]["confirmed"]["longest_tick_without_delay"]["below"], "decays");
  EXPECT_EQ(held["cases"][0]["confirmed"]["longest_tick_without_delay"]["above"], "grows");
  expect_refused({"stability", experiment("four_bar_swing")}, 2, "no_path", "closes no loop");
  Command words({bin("mixloop"), "stability", experiment("hold_pose"), "--no-confirmation", "--set",
                 "controller.about.torque=[0, 0, 0]"});
  EXPECT_EQ(words.wait(), 0);
  EXPECT_THAT(words.out(),
              testing::AllOf(HasSubstr("about the state that is fed back about"),
                             HasSubstr("fed back about is no rest"), Not(HasSubstr("on the path"))));
}

TEST(FreeMotion, GoesInRealTime) {
  const ScratchFolder folder;
  const std::string out = folder.file("kept");
  Command run({bin("mixloop"), "run", experiment("hold_pose"), "--realtime", "--speed", "0.5", "--out", out,
               "--set", "real_time.max_missed=1000", "--set", "expect={}", "--json"});
  ASSERT_EQ(run.wait(), 0) << run.out() << run.err();
  const auto again = said_by({"simulate", experiment("hold_pose"), "--ages", out + "/ages.csv", "--set",
                              "real_time.max_missed=1000", "--set", "expect={}"});
  EXPECT_EQ(again["trajectory_sha256"], run.json()["trajectory_sha256"]);
}

}  // namespace
}  // namespace mixloop
