// SPDX-License-Identifier: MIT
// Faults by message do what the schedule's do, and what is refused is said at both ends.
#include <gmock/gmock.h>

#include "runtime/bus/bus.hpp"
#include "tests/support/command.hpp"
#include "tests/support/heard.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

/// A fault in an experiment's words, and as a message of the same.
struct Meant {
  std::string scheduled;
  std::int8_t target, kind;
  std::int32_t index;
  double magnitude;
};

std::vector<std::string> line(const std::string& what, const std::vector<std::string>& more) {
  std::vector<std::string> words = {bin("mixloop"),
                                    what,
                                    experiment("paper"),
                                    "--set",
                                    "expect={}",
                                    "--set",
                                    "limits.position_error=10 m",
                                    "--set",
                                    "plant.actuators={friction: {viscous: 0.001}}",
                                    "--set",
                                    "seed=3"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Sends a fault to the plant that is heard, to act from 0.2 s on; the kind of the plant's answer.
std::int8_t answer_to(const Meant& meant) {
  struct Ears {
    void on_state(Bytes bytes) {
      if (const auto header = peek(bytes)) plant = header;
    }
    void on_fault(Bytes bytes) {
      fault_t heard;
      if (decode(bytes, heard) && heard.kind < fault_t::KIND_NONE) answer = heard.kind;
    }
    std::optional<Header> plant;
    std::int8_t answer = 0;
  } ears;
  Bus bus;
  bus.subscribe<&Ears::on_state>(bus.channel("STATE"), &ears);
  bus.subscribe<&Ears::on_fault>(bus.channel("FAULT"), &ears);
  const StopSwitch never;
  const Instant until = now() + std::chrono::seconds(60);
  while (!ears.plant && now() < until) bus.wait(until, never);
  Outbox<fault_t> fault(3);
  Header header = ears.plant.value_or(Header{});
  header.n = 3, header.utime = 200'000, header.seq = 1;
  set_header(fault.message, header);
  fault.message.target = meant.target;
  fault.message.kind = meant.kind;
  fault.message.index = meant.index;
  fault.message.magnitude = meant.magnitude;
  fault.message.duration = 0.1;
  bus.publish(bus.channel("FAULT"), fault.encode());
  while (ears.answer == 0 && now() < until) bus.wait(until, never);
  return ears.answer;
}

TEST(FaultByMessage, OfEveryKindDoesWhatTheSchedulesDoes) {
  using F = fault_t;
  for (const Meant& meant : std::vector<Meant>{
           {"motor: 2, kind: off", F::TARGET_MOTOR, F::KIND_OFF, 1, 0},
           {"motor: all, kind: stuck", F::TARGET_MOTOR, F::KIND_STUCK, -1, 0},
           {"motor: 1, kind: garbage, magnitude: 0.5", F::TARGET_MOTOR, F::KIND_GARBAGE, 0, 0.5},
           {"sensor: 3, kind: wrong, magnitude: 0.01", F::TARGET_SENSOR, F::KIND_WRONG, 2, 0.01},
           {"motor: 3, kind: slow, magnitude: 1 ms", F::TARGET_MOTOR, F::KIND_SLOW, 2, 1e-3},
           {"motor: 3, kind: delayed, magnitude: 2 ms", F::TARGET_MOTOR, F::KIND_DELAYED, 2, 2e-3},
           {"sensor: 1, kind: intermittent, magnitude: 0.01", F::TARGET_SENSOR, F::KIND_INTERMITTENT, 0,
            0.01},
           {"parameter: payload, value: 2 kg", F::TARGET_PAYLOAD, F::KIND_CHANGED, -1, 2},
           {"parameter: payload, value: 2 kg", F::TARGET_PARAMETER, F::KIND_CHANGED, 0, 2},
           {"friction: 3", F::TARGET_FRICTION, F::KIND_CHANGED, -1, 3}}) {
    SCOPED_TRACE(meant.scheduled);
    Command run(line("run", {"--json", "--paused", "--allow-faults"}));
    EXPECT_EQ(answer_to(meant), fault_t::KIND_TAKEN);
    Command resume({bin("mixloop"), "control", "resume"});
    EXPECT_EQ(resume.wait(), 0);
    Command simulate(
        line("simulate", {"--json", "--set", "faults=[{at: 0.2 s, for: 0.1 s, " + meant.scheduled + "}]"}));
    Command sound(line("simulate", {"--json"}));
    for (Command* command : {&run, &simulate, &sound}) ASSERT_EQ(command->wait(), 0) << command->err();
    EXPECT_EQ(run.json()["trajectory_sha256"], simulate.json()["trajectory_sha256"]);
    EXPECT_NE(run.json()["trajectory_sha256"], sound.json()["trajectory_sha256"]) << "nothing happened";
  }
}

/// `mixloop control fault` on a plant that is running, and what was said at its end and at the plant's.
struct Said {
  int status;
  std::string operators, plants;
};
Said said_of(const std::vector<std::string>& fault,
             const std::vector<std::string>& more = {"--allow-faults"}) {
  std::vector<std::string> words = {bin("mixloop"), "run", experiment("paper"), "--paused"};
  words.insert(words.end(), more.begin(), more.end());
  Command run(words);
  std::vector<std::string> control = {bin("mixloop"), "control", "fault", "--patience", "60"};
  control.insert(control.end(), fault.begin(), fault.end());
  Command command(control);
  const int status = command.wait();
  Command stop({bin("mixloop"), "control", "stop"});
  stop.wait();
  run.wait();
  return {status, command.out() + command.err(), run.err()};
}

TEST(FaultByMessage, ThatIsTakenIsSaidToTheOperator) {
  const Said said = said_of({"payload", "changed", "--magnitude", "2"});
  EXPECT_EQ(said.status, 0);
  EXPECT_THAT(said.operators, HasSubstr("which has taken it"));
}

TEST(FaultByMessage, ThatCannotBeIsRefusedAtBothEnds) {
  const Said parameter = said_of({"parameter", "changed", "--index", "2", "--magnitude", "2"});
  EXPECT_EQ(parameter.status, 3);
  EXPECT_THAT(parameter.operators, HasSubstr("refused"));
  EXPECT_THAT(parameter.plants,
              HasSubstr("FAULT refused: there is no parameter 2; the scene's parameters: 1 payload"));
  const Said friction = said_of({"friction", "changed", "--magnitude", "2"});
  EXPECT_EQ(friction.status, 3);
  EXPECT_THAT(friction.plants, HasSubstr("neither the scene nor plant.actuators has friction"));
  const Said mass = said_of({"payload", "changed", "--magnitude", "-1"});
  EXPECT_EQ(mass.status, 3);
  EXPECT_THAT(mass.plants, HasSubstr("FAULT refused: with this value, "));
}

TEST(FaultByMessage, IsNotObeyedWhereThatIsNotAllowedAndBothSaySo) {
  const Said said = said_of({"motor", "off"}, {});
  EXPECT_EQ(said.status, 0);
  EXPECT_THAT(said.operators, HasSubstr("start it with --allow-faults"));
  EXPECT_THAT(said.plants, HasSubstr("started without --allow-faults"));
}

TEST(FaultByMessage, ThatNoPlantCouldTakeIsNotSent) {
  const auto refused = [](const std::vector<std::string>& fault, const std::string& why) {
    std::vector<std::string> words = {bin("mixloop"), "control", "fault", "--patience", "0.1"};
    words.insert(words.end(), fault.begin(), fault.end());
    Command command(words);
    EXPECT_EQ(command.wait(), 2);
    EXPECT_THAT(command.err(), HasSubstr(why));
  };
  refused({"payload", "changed"}, "expected --magnitude");
  refused({"payload", "off"}, "can only be changed");
  refused({"parameter", "changed", "--magnitude", "1"}, "expected --index");
  refused({"motor", "changed", "--magnitude", "1"}, "motors and sensors have no such kind");
  refused({"motor", "off", "--magnitude", "1"}, "expected it without");
  refused({"sensor", "intermittent", "--magnitude", "2"}, "not within 0 to 1");
}

}  // namespace
}  // namespace mixloop
