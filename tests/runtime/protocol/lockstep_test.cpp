// SPDX-License-Identifier: MIT
// The whole of lockstep in three processes: whatever the network and the scheduler do, the plant must get the
// same commands.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "runtime/bus/bus.hpp"
#include "tests/runtime/protocol/toy_loop.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/support/bad_network.hpp"
#include "tests/support/command.hpp"

namespace mixloop {
namespace {

using namespace std::chrono_literals;

constexpr auto kLimit = 60s;
constexpr int kTicks = 1000;
const std::vector<std::string> kRoles{"plant", "controller", "planner"};

using Started = std::unique_ptr<Command>;

Started start(const std::string& role, int last_tick = kTicks,
              const std::vector<std::string>& environment = {}, const std::vector<std::string>& more = {}) {
  std::vector<std::string> command{MIXLOOP_TOY_PROCESS, role, std::to_string(last_tick)};
  command.insert(command.end(), more.begin(), more.end());
  return std::make_unique<Command>(command, environment);
}

nlohmann::json finish(Command& child, const std::string& role, int expected_status = 0) {
  const int status = child.wait(kLimit);
  const std::string text = child.out() + child.err();
  EXPECT_EQ(status, expected_status) << role << ": " << text;
  const auto at = text.find('{');
  return at == std::string::npos ? nlohmann::json{} : nlohmann::json::parse(text.substr(at), nullptr, false);
}

/// Waits for all three and holds what must be true of any run.
nlohmann::json finish_all(std::vector<Started>& children, const std::vector<std::string>& roles) {
  nlohmann::json reports;
  for (std::size_t i = 0; i < children.size(); ++i) reports[roles[i]] = finish(*children[i], roles[i]);
  EXPECT_EQ(reports["plant"].value("digest", ""), toy::expected_digest(kTicks)) << reports.dump(1);
  for (const std::string& role : roles) EXPECT_EQ(reports[role].value("ending", ""), "finished") << role;
  return reports;
}

/// Waits until the plant has come to a tick: that all three are up and at work.
void wait_for_tick(std::int64_t tick) {
  struct Watch {
    std::int64_t latest = -1;
    void take(Bytes bytes) {
      if (const auto header = peek(bytes)) latest = header->seq;
    }
  } watch;
  Bus bus;
  const StopSwitch never;
  bus.subscribe<&Watch::take>(bus.channel("STATE"), &watch);
  const Instant limit = now() + kLimit;
  while (watch.latest < tick && now() < limit) bus.wait(limit, never);
  EXPECT_GE(watch.latest, tick);
}

class StartOrder : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(StartOrder, DoesntChangeWhatThePlantIsTold) {
  std::vector<Started> children;
  for (const std::string& role : GetParam()) {
    children.push_back(start(role));
    std::this_thread::sleep_for(40ms);  // long enough to be up, so that the order is real
  }
  finish_all(children, GetParam());
}

std::vector<std::vector<std::string>> all_orders() {
  std::vector<std::string> roles = kRoles;
  std::sort(roles.begin(), roles.end());
  std::vector<std::vector<std::string>> orders;
  do orders.push_back(roles);
  while (std::next_permutation(roles.begin(), roles.end()));
  return orders;
}

INSTANTIATE_TEST_SUITE_P(AllSix, StartOrder, testing::ValuesIn(all_orders()), [](const auto& order) {
  return order.param[0] + "_" + order.param[1] + "_" + order.param[2];
});

class BadNetwork : public testing::TestWithParam<int> {};

TEST_P(BadNetwork, LosesDoublesAndReordersDatagramsWithoutChangingACommand) {
  std::vector<Started> children;
  int seed = 100 * GetParam();
  for (const std::string& role : kRoles) children.push_back(start(role, kTicks, bad_network(++seed)));
  const auto reports = finish_all(children, kRoles);
  EXPECT_GT(reports["plant"].value("resent", 0), 20) << "the network wasn't bad";
}

INSTANTIATE_TEST_SUITE_P(Seeds, BadNetwork, testing::Values(1, 2, 3));

TEST(Lockstep, SurvivesProcessesThatAreStoppedAndContinued) {
  std::vector<Started> children;
  // Paced, so that the run lasts long enough to be disturbed: 0.5 s.
  for (const std::string& role : kRoles) children.push_back(start(role, kTicks, {}, {"0", "2"}));
  std::mt19937 random(7);
  for (int i = 0; i < 8; ++i) {
    const Command& victim = *children[random() % children.size()];
    std::this_thread::sleep_for(std::chrono::milliseconds(10 + random() % 30));
    victim.signal(SIGSTOP);
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 40));
    victim.signal(SIGCONT);
  }
  finish_all(children, kRoles);
}

/// A process of nobody's that hears everything and answers with what must do no harm: random bytes, messages
/// cut short, too long, of another session, n, type or config, with NaN, from the past.
class Stranger {
 public:
  Stranger() {
    for (const char* name : {"STATE", "REFERENCE", "COMMAND", "SIM_CONTROL"}) {
      channels_.push_back(bus_.channel(name));
      bus_.subscribe<&Stranger::remember>(channels_.back(), this);
    }
  }

  /// About three thousand times a second: it is to disturb, not to drown.
  void annoy_until(const std::function<bool()>& over) {
    const StopSwitch never;
    for (Instant next = now(); !over();) {
      if (bus_.wait(next, never) == Wake::message) continue;
      next = now() + 300us;
      if (!heard_.empty()) annoy();
    }
  }

 private:
  // The fields of the header that make a message another one's, by their offset.
  static constexpr std::size_t kFingerprint = 0, kN = 8, kSession = 28, kConfig = 36, kNumbers = 44;

  void remember(Bytes bytes) {
    if (heard_.size() < 4000 && bytes.size() >= kNumbers + 8) heard_.emplace_back(bytes.begin(), bytes.end());
  }
  void annoy() {
    std::vector<std::uint8_t> bytes = heard_[random_() % heard_.size()];
    const auto spoil = [&](std::size_t at) {
      bytes[at + random_() % 4] ^= static_cast<std::uint8_t>(1 + random_() % 255);
    };
    switch (random_() % 8) {
      case 0:
        bytes.resize(random_() % bytes.size());
        break;
      case 1:
        bytes.resize(bytes.size() + 1 + random_() % 9000);
        break;
      case 2:
        spoil(kFingerprint);
        break;
      case 3:
        spoil(kN);
        break;
      case 4:
        spoil(kSession);
        break;
      case 5:
        spoil(kConfig);
        break;
      case 6:
        std::fill_n(bytes.begin() + kNumbers, 8, std::uint8_t{0xff});
        break;
      default:
        break;  // as it was: a replay
    }
    bus_.publish(channels_[random_() % channels_.size()], bytes);
  }

  Bus bus_;
  std::vector<std::string> channels_;
  std::vector<std::vector<std::uint8_t>> heard_;
  std::mt19937_64 random_{5};
};

TEST(Lockstep, IsntDisturbedByStrangers) {
  std::vector<Started> children;
  for (const std::string& role : kRoles) children.push_back(start(role, kTicks, {}, {"42", "2"}));
  Stranger stranger;
  stranger.annoy_until([&] { return !children[0]->running(); });
  const auto reports = finish_all(children, kRoles);
  for (const std::string& role : kRoles) EXPECT_GT(reports[role].value("rejected", 0), 50) << role;
}

TEST(Lockstep, AllocatesNothingPerTickInAnyOfTheThree) {
  if (!AllocationCounter::works()) GTEST_SKIP() << "a sanitizer has malloc";
  std::vector<Started> children;
  for (const std::string& role : kRoles) children.push_back(start(role));
  const auto reports = finish_all(children, kRoles);
  for (const std::string& role : kRoles)
    EXPECT_EQ(reports[role].value("allocations", -1), 0)
        << role << " first by " << reports[role]["allocated_by"];
}

TEST(Lockstep, EndsEverywhereWhenThePlantIsInterrupted) {
  std::vector<Started> children;
  for (const std::string& role : kRoles) children.push_back(start(role, 1'000'000, {}, {"0", "1"}));
  wait_for_tick(100);
  children[0]->signal(SIGINT);
  EXPECT_EQ(finish(*children[0], "plant", 130).value("ending", ""), "interrupted");
  EXPECT_EQ(finish(*children[1], "controller").value("ending", ""), "interrupted");
  EXPECT_EQ(finish(*children[2], "planner").value("ending", ""), "interrupted");
}

TEST(Lockstep, GoesOnWithAControllerThatReplacesAKilledOne) {
  std::vector<Started> children;
  for (const std::string& role : kRoles) children.push_back(start(role, kTicks, {}, {"0", "1"}));
  wait_for_tick(100);
  children[1]->signal(SIGKILL);
  EXPECT_EQ(children[1]->wait(5s), 128 + SIGKILL);
  children[1] = start("controller");
  const auto reports = finish_all(children, kRoles);
  EXPECT_TRUE(reports["controller"].value("joined_late", false));
  EXPECT_GT(reports["plant"].value("joined_late", 0), 0);
}

}  // namespace
}  // namespace mixloop
