// SPDX-License-Identifier: MIT
// The controllers of examples/ against our plant and planner: a PD law, so the bytes of law `pd`.
#include <gmock/gmock.h>

#include <csignal>
#include <filesystem>

#include "tests/runtime/protocol/scripted_peer.hpp"
#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

/// A stranger's controller, as it is started; no words where this machine can't.
struct Stranger {
  std::string name;
  std::vector<std::string> words, environment;
};

const std::string kPython = "/usr/bin/python3";
const std::vector<std::string> kPythonTypes = {
    "PYTHONPATH=" MIXLOOP_TYPES_PYTHON ":" MIXLOOP_SOURCE "/examples", "PYTHONDONTWRITEBYTECODE=1"};

void PrintTo(const Stranger& stranger, std::ostream* out) { *out << stranger.name; }

std::vector<Stranger> strangers() {
  std::vector<Stranger> all = {
      {.name = "Cpp", .words = {bin("example_controller")}}, {.name = "Python"}, {.name = "Java"}};
  if (std::filesystem::exists(kPython)) {
    all[1].words = {kPython, MIXLOOP_SOURCE "/examples/controller.py"};
    all[1].environment = kPythonTypes;
  }
  const std::string classes = MIXLOOP_JAVA_CLASSES;
  if (!classes.empty())
    all[2].words = {"/usr/bin/java", "-Djava.net.preferIPv4Stack=true", "-cp", classes, "Controller"};
  return all;
}

class Examples : public testing::TestWithParam<Stranger> {
 protected:
  void SetUp() override {
    if (GetParam().words.empty()) GTEST_SKIP() << "not on this machine";
  }

  /// Starts it and asks it of tick 0 until it answers; what it says after that is of other questions.
  void start() {
    controller.emplace(GetParam().words, GetParam().environment);
    const auto answers = [&] {
      ask(0);
      return script.next_bytes("COMMAND", std::chrono::milliseconds(100)).has_value();
    };
    ASSERT_TRUE(eventually(answers)) << controller->err();
    while (script.next_bytes("COMMAND", std::chrono::milliseconds(200))) {
    }
  }
  void ask(std::int64_t tick, std::int64_t session = kScriptSession) {
    auto reference = ScriptedPeer::message<reference_t>(tick);
    auto state = ScriptedPeer::message<state_t>(tick);
    reference.session = state.session = session;
    reference.psi_desired[0] = static_cast<double>(session);
    script.send("REFERENCE", reference);
    script.send("STATE", state);
  }
  void end(std::int64_t session) { script.send_end(session); }
  /// All that comes until there is silence.
  std::vector<command_t> answers() {
    std::vector<command_t> all;
    while (auto command = script.next<command_t>("COMMAND", std::chrono::milliseconds(300)))
      all.push_back(*command);
    return all;
  }

  ScriptedPeer script{"COMMAND"};
  std::optional<Command> controller;
};

const std::vector<std::string> kPd = {"--set", "controller.law=pd", "--set", "expect={}", "--json"};
std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST_P(Examples, GiveTheBytesOfPd) {
  Command simulate(with({bin("mixloop"), "simulate", experiment("paper")}, kPd));
  Command run(with({bin("mixloop"), "run", experiment("paper"), "--without", "controller"}, kPd));
  Command stranger(GetParam().words, GetParam().environment);
  ASSERT_EQ(simulate.wait(), 0) << simulate.err();
  ASSERT_EQ(run.wait(), 0) << run.err() << stranger.err();
  EXPECT_EQ(stranger.wait(), 0) << stranger.err();
  EXPECT_EQ(run.json()["trajectory_sha256"], simulate.json()["trajectory_sha256"]);
}

TEST_P(Examples, AnswerARepeatedStateByTheSameBytes) {
  start();
  ask(1);
  const auto first = script.next_bytes("COMMAND");
  ASSERT_TRUE(first);
  ask(1);
  EXPECT_EQ(script.next_bytes("COMMAND"), first);
}

TEST_P(Examples, AnswerTheNewestOfAllThatWaits) {
  start();
  controller->signal(SIGSTOP);
  for (int i = 0; i < 20; ++i) ask(1);
  for (int i = 0; i < 20; ++i) ask(2);
  controller->signal(SIGCONT);
  const auto heard = answers();
  ASSERT_FALSE(heard.empty());
  EXPECT_EQ(heard.back().seq, 2);
  // A thread of LCM's reads, and the answering one may look in between, in Java again and again; one by one
  // would be 40.
  if (GetParam().name != "Java") {
    EXPECT_LT(heard.size(), 20U);
  }
}

TEST_P(Examples, FollowOneSessionWhateverElseIsOnTheBus) {
  constexpr std::int64_t kOther = kScriptSession + 1;
  start();
  for (std::int64_t k = 1; k < 20; ++k) {
    ask(k + 7, kOther);
    ask(k);
    ask(k, kOther);
    const auto command = script.next<command_t>("COMMAND");
    ASSERT_TRUE(command) << controller->err();
    EXPECT_EQ(command->session, kScriptSession);
    EXPECT_EQ(command->seq, k);
    EXPECT_EQ(command->tau_commanded[0], 100.0 * kScriptSession);
  }
  end(kOther);
  EXPECT_TRUE(answers().empty());
  EXPECT_TRUE(controller->running()) << "another run's END is not ours";
  end(kScriptSession);
  EXPECT_EQ(controller->wait(std::chrono::seconds(10)), 0);
}

TEST_P(Examples, FollowAnotherSessionWhenTheirsHasFallenSilent) {
  start();
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  std::optional<command_t> command;
  // As the plant and the planner do, which send both again.
  EXPECT_TRUE(eventually([&] {
    ask(0, kScriptSession + 1);
    return (command = script.next<command_t>("COMMAND", std::chrono::milliseconds(100))).has_value();
  }));
  ASSERT_TRUE(command);
  EXPECT_EQ(command->session, kScriptSession + 1);
}

INSTANTIATE_TEST_SUITE_P(Controller, Examples, testing::ValuesIn(strangers()),
                         [](const auto& test) { return test.param.name; });

// Repeated states that come while it computes cost it nothing: 101 ticks of 8 ms.
TEST(SlowExample, CostsWhatItsLawCosts) {
  if (!std::filesystem::exists(kPython)) GTEST_SKIP() << "no python3";
  Command run(with({bin("mixloop"), "run", experiment("paper"), "--without", "controller", "--set",
                    "path.duration=0.1 s", "--set", "limits.position_error=10 m"},
                   kPd));
  Command slow({kPython, "-c",
                "import time, controller\n"
                "law = controller.torque\n"
                "def torque(i, *x):\n"
                "    if i == 0: time.sleep(0.008)\n"
                "    return law(i, *x)\n"
                "controller.torque = torque\n"
                "controller.main()"},
               kPythonTypes);
  ASSERT_EQ(run.wait(), 0) << run.err() << slow.err();
  EXPECT_LT(run.json()["wall_time"], 101 * 0.016);
}

}  // namespace
}  // namespace mixloop
