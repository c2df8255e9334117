// SPDX-License-Identifier: MIT
// The plant's ear for FAULT: whose messages it takes, and how many.
#include "processes/fault_ear.hpp"

#include <gtest/gtest.h>

#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kSessionOfFaults = 77, kConfigOfFaults = 4711;

Experiment faultable() {
  Experiment loaded = load_experiment(std::filesystem::path(experiment("paper")), {});
  loaded.evaluation = Evaluation::interpreter;
  loaded.plant.faults.injected = true;
  return loaded;
}

class FaultEarTest : public testing::Test {
 protected:
  FaultEarTest() {
    report_.session = kSessionOfFaults;
    bus_.subscribe<&FaultEarTest::on_answer>(bus_.channel("FAULT"), this);
  }

  static fault_t fault(std::int64_t count, std::int8_t kind = fault_t::KIND_OFF) {
    fault_t message = blank<fault_t>(3);
    set_header(message, {.n = 3, .seq = count, .session = kSessionOfFaults, .config = kConfigOfFaults});
    message.kind = kind;
    return message;
  }
  /// Sends it and waits until the ear has dropped it or answered.
  void say(Bus& from, const fault_t& message) {
    Outbox<fault_t> out(3);
    out.message = message;
    const auto dealt_with = [this] { return report_.rejects.total() + answers_; };
    const std::uint64_t before = dealt_with();
    from.publish(from.channel("FAULT"), out.encode());
    for (const Instant end = now() + 5s; dealt_with() == before && now() < end;) bus_.wait(end, never_);
    EXPECT_EQ(dealt_with(), before + 1);
  }
  void on_answer(Bytes bytes) {
    fault_t heard;
    if (decode(bytes, heard) && heard.kind < fault_t::KIND_NONE) ++answers_;
  }
  void take_tick() {
    const double tau[] = {0, 0, 0};
    run_.lockstep_tick(tau, ear_.heard(), [](std::int64_t) { return true; });
    ear_.forget();
  }

  Experiment experiment_ = faultable();
  Plan plan_ = make_plan(experiment_);
  RecordedPlant run_{experiment_, plan_};
  PlantReport report_;
  Bus bus_, operator_, other_operator_;
  StopSwitch never_;
  FaultEar ear_{bus_, run_, true, kConfigOfFaults, report_};
  std::uint64_t answers_ = 0;
};

TEST_F(FaultEarTest, OrdersTheFaultsOfEachSender) {
  say(operator_, fault(1000));
  say(other_operator_, fault(5));  // whose clock is another
  EXPECT_EQ(ear_.heard().size(), 2U);
  say(operator_, fault(1000));  // repeated
  say(operator_, fault(999));   // overtaken
  EXPECT_EQ(ear_.heard().size(), 2U);
  EXPECT_EQ(to_string(report_.rejects), "2 stale");
}

TEST_F(FaultEarTest, TakesNoneForAnotherExperiment) {
  fault_t message = fault(1);
  message.config ^= 1;
  say(operator_, message);
  message = fault(2);
  message.session ^= 1;
  say(operator_, message);
  EXPECT_TRUE(ear_.heard().empty());
  EXPECT_EQ(to_string(report_.rejects), "1 session, 1 config");
}

TEST_F(FaultEarTest, CountsWhatItRefuses) {
  fault_t message = fault(1);
  message.index = 7;
  say(operator_, message);
  EXPECT_TRUE(ear_.heard().empty());
  EXPECT_EQ(report_.refused_faults, 1U);
}

TEST_F(FaultEarTest, TakesAThousandAndAlwaysWhatHeals) {
  ASSERT_TRUE(run_.begin());
  std::int64_t count = 0;
  for (std::size_t i = 0; i < DeadlinePlant::kInjected; ++i) {
    say(operator_, fault(++count));
    take_tick();
  }
  EXPECT_EQ(report_.refused_faults, 0U);
  ASSERT_TRUE(run_.plant().faults()->active);
  say(operator_, fault(++count));
  EXPECT_EQ(report_.refused_faults, 1U);
  say(operator_, fault(++count, fault_t::KIND_NONE));
  say(operator_, fault(++count, fault_t::KIND_NONE));  // once is enough
  EXPECT_EQ(ear_.heard().size(), 1U);
  take_tick();
  EXPECT_FALSE(run_.plant().faults()->active);
  EXPECT_EQ(run_.deadlines().arrivals().interventions.size(), DeadlinePlant::kInjected + 1);
}

// A plant that is paused stays in its tick.
TEST_F(FaultEarTest, TakesWhatHealsInATickThatHasHeardEnough) {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < Faults::kWaiting; ++i) say(operator_, fault(++count));
  say(operator_, fault(++count));
  EXPECT_EQ(report_.refused_faults, 1U);
  say(operator_, fault(++count, fault_t::KIND_NONE));
  EXPECT_EQ(ear_.heard().size(), Faults::kWaiting + 1);
}

}  // namespace
}  // namespace mixloop
