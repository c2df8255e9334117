// SPDX-License-Identifier: MIT
#include "watch/tick_assembly.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <random>
#include <string>

namespace mixloop {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::int64_t kAssembledSession = 7;
constexpr auto kWhole = [](const HeardTick& tick) { return tick.get<state_t>() && tick.get<command_t>(); };

template <class Message>
Message message(std::int64_t tick, std::int64_t session = kAssembledSession) {
  Message m = blank<Message>(1);
  const auto utime =
      static_cast<std::int64_t>(1000 * static_cast<std::uint64_t>(tick));  // of hostile ticks too
  set_header(m, {.n = 1, .utime = utime, .seq = tick, .session = session, .config = 5});
  return m;
}

/// "3src": of tick 3 its state, reference and command were heard.
std::string text_of(const HeardTick& tick) {
  std::string text = std::to_string(tick.k);
  if (tick.get<state_t>()) text += 's';
  if (tick.get<reference_t>()) text += 'r';
  if (tick.get<command_t>()) text += 'c';
  if (tick.get<truth_t>()) text += 't';
  return text;
}

/// An assembly of session 7 from tick 0 on, and what it has given.
class Assembly : public testing::Test {
 protected:
  void begin(TickAssembly::Options options = {}) {
    options.on_tick = [this](const HeardTick& tick) { given.push_back(text_of(tick)); };
    ticks.emplace(options);
    ticks->begin(kAssembledSession, 0);
  }
  Taken state(std::int64_t k) { return ticks->add(message<state_t>(k)); }
  Taken reference(std::int64_t k) { return ticks->add(message<reference_t>(k)); }
  Taken command(std::int64_t k) { return ticks->add(message<command_t>(k)); }
  std::string found(std::int64_t k) const {
    const HeardTick* tick = ticks->find(k);
    return tick ? text_of(*tick) : "";
  }

  std::optional<TickAssembly> ticks;
  std::vector<std::string> given;
};

TEST_F(Assembly, GivesATickWhenItIsComplete) {
  begin({.complete = kWhole});
  reference(0);
  state(0);
  EXPECT_THAT(given, IsEmpty());
  reference(1);
  command(0);
  EXPECT_THAT(given, ElementsAre("0src"));
  state(1);
  command(1);
  EXPECT_THAT(given, ElementsAre("0src", "1src"));
}

TEST_F(Assembly, WaitsForWhatIsMissingAsLongAsItsPatienceLasts) {
  begin({.patience = 3, .complete = kWhole});
  state(0);
  state(1);
  command(1);
  state(2);
  EXPECT_THAT(given, IsEmpty()) << "in their order: tick 0 has no command yet";
  state(3);
  EXPECT_THAT(given, ElementsAre("0s", "1sc"));
  command(3);
  EXPECT_THAT(given, ElementsAre("0s", "1sc")) << "tick 2 comes first";
  command(2);
  EXPECT_THAT(given, ElementsAre("0s", "1sc", "2sc", "3sc"));
}

TEST_F(Assembly, GivesNothingOfATickThatWasLostWhole) {
  begin();
  state(0);
  state(4);
  reference(5);
  ticks->finish();
  EXPECT_THAT(given, ElementsAre("0s", "4s")) << "nor of what is past the newest state";
}

TEST_F(Assembly, TakesTheFirstOfDoubledMessages) {
  begin();
  auto first = message<state_t>(0), second = first;
  first.psi_measured[0] = 1;
  EXPECT_EQ(ticks->add(first, 100), Taken::fresh);
  EXPECT_EQ(ticks->add(second, 200), Taken::repeated);
  EXPECT_EQ(ticks->find<state_t>(0)->psi_measured[0], 1);
  EXPECT_EQ(ticks->find(0)->heard_at<state_t>(), 100);
}

TEST_F(Assembly, PutsAnyOrderWithinTheWindowRight) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 20; ++trial) {
    SCOPED_TRACE(trial);
    given.clear();
    begin({.behind = 40});
    // Each message is overtaken by at most 30 ticks.
    std::vector<std::pair<std::int64_t, char>> order;
    for (std::int64_t k = 0; k < 300; ++k)
      for (const char type : {'s', 'r', 'c'})
        order.emplace_back(3 * k + static_cast<std::int64_t>(random() % 90), type);
    std::vector<std::size_t> by_time(order.size());
    for (std::size_t i = 0; i < by_time.size(); ++i) by_time[i] = i;
    std::ranges::sort(by_time, {}, [&](std::size_t i) { return order[i].first; });
    for (const std::size_t i : by_time) {
      const auto k = static_cast<std::int64_t>(i / 3);
      const char type = order[i].second;
      EXPECT_EQ(type == 's' ? state(k) : type == 'r' ? reference(k) : command(k), Taken::fresh);
    }
    ticks->finish();
    ASSERT_EQ(given.size(), 300u);
    for (std::size_t k = 0; k < 300; ++k) EXPECT_EQ(given[k], std::to_string(k) + "src");
  }
}

TEST_F(Assembly, KeepsToItsSession) {
  begin();
  state(0);
  EXPECT_EQ(ticks->add(message<command_t>(0, 8)), Taken::other_session);
  EXPECT_EQ(ticks->add(message<state_t>(1, 8)), Taken::other_session);
  EXPECT_EQ(ticks->newest(), 0);
  EXPECT_EQ(found(0), "0s");
}

TEST_F(Assembly, RefusesAnotherConfigWhereItHasOne) {
  begin({.config = 5});
  EXPECT_EQ(state(0), Taken::fresh);
  auto other = message<command_t>(0, 8);
  other.config = 6;
  EXPECT_EQ(ticks->add(other), Taken::other_config) << "whichever session it is of";
}

TEST_F(Assembly, ForgetsTheOldSessionWhenThePlantBeginsAgainAtTick0) {
  begin({.complete = kWhole});
  for (std::int64_t k = 0; k < 500; ++k) state(k), command(k);
  reference(500);
  ticks->begin(8, 0);
  EXPECT_EQ(found(499) + found(500), "");
  EXPECT_EQ(state(500), Taken::other_session);
  given.clear();
  ticks->add(message<state_t>(0, 8));
  ticks->add(message<command_t>(0, 8));
  EXPECT_THAT(given, ElementsAre("0sc"));
  EXPECT_EQ(ticks->newest(), 0);
}

TEST_F(Assembly, BeginsWhereItIsTold) {
  begin();
  ticks->begin(kAssembledSession, 1000);
  EXPECT_EQ(ticks->newest(), 999);
  EXPECT_EQ(reference(999), Taken::late);
  EXPECT_EQ(reference(1001), Taken::fresh);
  EXPECT_EQ(state(1000), Taken::fresh);
}

TEST_F(Assembly, ForgetsWhatTheWindowHasLeft) {
  begin({.behind = 10, .patience = 1});
  for (std::int64_t k = 0; k <= 20; ++k) state(k);
  EXPECT_EQ(given.size(), 20u);
  EXPECT_EQ(command(11), Taken::fresh) << "given already, and still there to be looked up";
  EXPECT_EQ(found(11), "11sc");
  EXPECT_EQ(command(10), Taken::late);
  EXPECT_EQ(found(10), "");
  EXPECT_EQ(reference(11 + 10 + TickAssembly::kAhead - 1), Taken::fresh);
  EXPECT_EQ(reference(11 + 10 + TickAssembly::kAhead), Taken::early);
  EXPECT_EQ(given.size(), 20u);
}

TEST_F(Assembly, DoesNotBelieveInTicksThatCannotBe) {
  constexpr auto kLast = std::numeric_limits<std::int64_t>::max();
  begin({.farthest_jump = 100});
  EXPECT_EQ(state(0), Taken::fresh);
  EXPECT_EQ(state(101), Taken::early);
  EXPECT_EQ(state(kLast), Taken::early);
  EXPECT_EQ(command(kLast), Taken::early);
  EXPECT_EQ(state(-1), Taken::late);
  EXPECT_EQ(state(100), Taken::fresh);
  // Without a bound of its own the runtime's holds.
  begin();
  EXPECT_EQ(state(kLast), Taken::early);
  ticks->begin(8, kLast);
  EXPECT_EQ(ticks->add(message<state_t>(kLast, 8)), Taken::early);
  EXPECT_EQ(ticks->add(message<state_t>(kFarthestTick, 8)), Taken::fresh);
}

}  // namespace
}  // namespace mixloop
