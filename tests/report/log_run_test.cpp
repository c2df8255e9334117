// SPDX-License-Identifier: MIT
#include "report/log_run.hpp"

#include <gmock/gmock.h>
#include <lcm/eventlog.h>

#include <cmath>

#include "runtime/bus/wire.hpp"
#include "tests/support/bad_input.hpp"
#include "tests/support/command.hpp"

namespace mixloop {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

struct Read {
  LogSession session;
  LogFacts facts;
  std::vector<Tick> ticks;
};

/// Writes a log message by message, as a logger would, and reads it back.
class Log {
 public:
  Log() : log_(lcm_eventlog_create(file_.c_str(), "w"), lcm_eventlog_destroy) {}

  template <class Message>
  void add(const std::string& channel, Outbox<Message>& outbox, std::int64_t at_us) {
    const Bytes bytes = outbox.encode();
    lcm_eventlog_event_t event{.eventnum = number_++,
                               .timestamp = at_us,
                               .channellen = static_cast<int>(channel.size()),
                               .datalen = static_cast<int>(bytes.size()),
                               .channel = const_cast<char*>(channel.c_str()),
                               .data = const_cast<std::uint8_t*>(bytes.data())};
    lcm_eventlog_write_event(log_.get(), &event);
  }

  void state(std::int64_t k, double psi, std::int64_t at_us, std::int64_t session = 7) {
    Outbox<state_t> outbox(1);
    set_header(outbox.message, {1, k % 1000 * 2000, k, session, 1});
    outbox.message.psi_measured[0] = psi;
    add("MIXLOOP_STATE", outbox, at_us);
  }
  void command(std::int64_t k, double tau, std::int64_t at_us, std::int64_t session = 7) {
    Outbox<command_t> outbox(1);
    set_header(outbox.message, {1, k % 1000 * 2000, k, session, 1});
    outbox.message.tau_commanded[0] = tau;
    add("MIXLOOP_COMMAND", outbox, at_us);
  }
  void reference(std::int64_t k, double psi, std::int64_t at_us) {
    Outbox<reference_t> outbox(1);
    set_header(outbox.message, {1, k * 2000, k, 7, 1});
    outbox.message.psi_desired[0] = psi;
    add("MIXLOOP_REFERENCE", outbox, at_us);
  }

  /// Nothing can be written any more.
  std::vector<LogSession> sessions() {
    log_.reset();
    return sessions_in(file_, "MIXLOOP_");
  }
  Read read() {
    Read all;
    all.session = sessions().front();
    all.facts = read_log(file_, "MIXLOOP_", all.session, all.session.rate_hz, 0,
                         [&](const Tick& tick) { all.ticks.push_back(tick); });
    return all;
  }

 private:
  ScratchFolder folder_;
  std::string file_ = folder_.file("log");
  std::unique_ptr<lcm_eventlog_t, decltype(&lcm_eventlog_destroy)> log_;
  std::int64_t number_ = 0;
};

TEST(LogRun, PutsTheMessagesOfATickTogether) {
  Log log;
  log.reference(0, 0.5, 900);  // before the state that it is for
  log.state(0, 1, 1000);
  log.state(0, 1, 6000);  // sent again: the age counts from the first
  log.command(0, 10, 6250);
  log.reference(1, 0.6, 6300);
  log.state(1, 1.5, 7000);
  log.command(1, 20, 7120);
  const Read all = log.read();
  EXPECT_EQ(all.session.rate_hz, 500);
  ASSERT_EQ(all.ticks.size(), 2u);
  EXPECT_EQ(all.ticks[1].t, 0.002);
  EXPECT_EQ(all.ticks[0].psi[0], 1);
  EXPECT_EQ(all.ticks[1].psi_desired[0], 0.6);
  EXPECT_EQ(all.ticks[1].tau_applied[0], 20);
  EXPECT_THAT(all.ticks[0].command_age, DoubleNear(5250e-6, 1e-15));  // a double's rounding of a microsecond
  EXPECT_EQ(all.ticks[1].work, 10 * 0.5);                             // tau(0) (psi(1) - psi(0))
  EXPECT_EQ(all.facts.commands_missing + all.facts.states_missing + all.facts.references_missing, 0);
}

// As on the bus: a reference comes before its state, all along.
TEST(LogRun, TakesMessagesThatComeEarlyInALongRun) {
  Log log;
  log.reference(0, 0, 0);
  for (int k = 0; k < 1000; ++k) {
    log.state(k, k, 1000 * k);
    log.reference(k + 1, k + 1, 1000 * k + 50);
    log.command(k, 1, 1000 * k + 100);
  }
  const Read all = log.read();
  ASSERT_EQ(all.ticks.size(), 1000u);
  EXPECT_EQ(all.facts.references_missing + all.facts.commands_missing + all.facts.dropped, 0);
  for (const Tick& tick : all.ticks) EXPECT_EQ(tick.psi_desired[0], tick.psi[0]);
}

TEST(LogRun, LeavesGapsWhereTheLogHasThem) {
  Log log;
  for (const int k : {0, 1, 4, 5}) {
    log.state(k, k, 1000 * k);
    if (k != 4) log.command(k, 1, 1000 * k + 100);
  }
  const Read all = log.read();
  ASSERT_EQ(all.ticks.size(), 6u);
  EXPECT_TRUE(std::isnan(all.ticks[2].psi[0]));
  EXPECT_EQ(all.ticks[5].psi[0], 5);
  EXPECT_TRUE(std::isnan(all.ticks[4].command_age));
  EXPECT_EQ(all.facts.states_missing, 2);
  EXPECT_EQ(all.facts.commands_missing, 1);
  EXPECT_EQ(all.facts.references_missing, 4);
}

TEST(LogRun, PrefersTruth) {
  Log log;
  log.state(0, 1, 1000);
  log.command(0, 10, 1100);
  Outbox<truth_t> truth(1);
  set_header(truth.message, {1, 0, 0, 7, 1});
  truth.message.tau_applied[0] = 8;
  truth.message.position[1] = 3;
  truth.message.work = 42;
  log.add("MIXLOOP_TRUTH", truth, 1200);
  const Read all = log.read();
  EXPECT_TRUE(all.facts.has_truth);
  EXPECT_EQ(all.ticks[0].tau[0], 10);
  EXPECT_EQ(all.ticks[0].tau_applied[0], 8);
  EXPECT_EQ(all.ticks[0].actual.position[1], 3);
  EXPECT_EQ(all.ticks[0].work, 42);
}

TEST(LogRun, NamesTheSessionsTheLongestFirst) {
  Log log;
  log.state(0, 0, 1, 3);
  for (int k = 5; k < 9; ++k) log.state(k, k, k, 4);
  const auto sessions = log.sessions();
  ASSERT_EQ(sessions.size(), 2u);
  EXPECT_EQ(sessions[0].session, 4);
  EXPECT_EQ(sessions[0].first_tick, 5);
  EXPECT_EQ(sessions[0].last_tick, 8);
  EXPECT_EQ(log.read().ticks.size(), 4u);
}

// A tick from far away neither makes a gap of its size nor ends what follows.
TEST(LogRun, DropsATickThatCantBe) {
  Log log;
  log.state(0, 0, 0);
  log.state(std::int64_t{1} << 60, 0, 1);
  log.state(1, 1, 2);
  const Read all = log.read();
  EXPECT_EQ(all.ticks.size(), 2u);
  EXPECT_EQ(all.facts.dropped, 1);
}

TEST(LogRun, RefusesALogWithoutStates) {
  Log log;
  log.command(0, 1, 1);
  const auto error = input_error([&] { log.sessions(); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, "no_states");
  EXPECT_THAT(error->message, testing::HasSubstr("MIXLOOP_STATE"));
}

}  // namespace
}  // namespace mixloop
