// SPDX-License-Identifier: MIT
// What is made of a session that was heard in any order.
#include "watch/session_judge.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "loop/simulate.hpp"
#include "runtime/protocol/config_hash.hpp"

namespace mixloop {
namespace {

constexpr std::int64_t kJudgedSession = 7;

/// A run of the paper's robot, and a judge that hears of it what a test lets it hear.
class JudgedSession : public testing::Test {
 protected:
  JudgedSession()
      : experiment_([] {
          auto loaded = load_experiment(std::filesystem::path(MIXLOOP_EXPERIMENTS "/paper.yaml"), {});
          loaded.evaluation = Evaluation::interpreter;
          return loaded;
        }()),
        plan_(make_plan(experiment_)),
        run_(experiment_, plan_),
        judge(experiment_, plan_),
        last(plan_.ticks()) {
    simulate(run_, [](std::int64_t) { return true; });
  }

  void state(std::int64_t k) {
    auto m = message<state_t>(k);
    const auto psi = run_.recorder().psi(k), psid = run_.recorder().psid(k);
    m.psi_measured.assign(psi.begin(), psi.end());
    m.psid_measured.assign(psid.begin(), psid.end());
    judge.on_state(bytes_of(m));
  }
  void command(std::int64_t k, std::int64_t session = kJudgedSession) {
    auto m = message<command_t>(k);
    m.session = session;
    const auto tau = run_.recorder().commanded(k);
    m.tau_commanded.assign(tau.begin(), tau.end());
    judge.on_command(bytes_of(m));
  }
  void ticks(std::int64_t first, std::int64_t end) {
    for (std::int64_t k = first; k < end; ++k) state(k), command(k);
  }
  void end() {
    auto m = message<sim_control_t>(last);
    m.action = sim_control_t::ACTION_END;
    judge.on_control(bytes_of(m));
  }
  void expect_the_whole_run() {
    EXPECT_TRUE(judge.over());
    const Result result = judge.finish(false, 0);
    EXPECT_EQ(result.missing_ticks, 0);
    EXPECT_EQ(result.run->measures.trajectory_sha256, run_.recorder().measures().trajectory_sha256);
  }

 private:
  template <class Message>
  Message message(std::int64_t k) const {
    auto m = blank<Message>(3);
    set_header(
        m, {.n = 3, .seq = k, .session = kJudgedSession, .config = config_of(common_ground(experiment_))});
    return m;
  }
  template <class Message>
  Bytes bytes_of(const Message& m) {
    buffer_.resize(static_cast<std::size_t>(m.getEncodedSize()));
    m.encode(buffer_.data(), 0, static_cast<int>(buffer_.size()));
    return buffer_;
  }

  Experiment experiment_;
  Plan plan_;
  RecordedPlant run_;
  std::vector<std::uint8_t> buffer_;

 protected:
  SessionJudge judge;
  std::int64_t last;
};

TEST_F(JudgedSession, MissesNothingThatCameInOrder) {
  ticks(0, last + 1);
  end();
  expect_the_whole_run();
}

TEST_F(JudgedSession, TakesACommandThatTheNextStateOvertook) {
  state(0);
  for (std::int64_t k = 0; k < last; ++k) state(k + 1), command(k);
  command(last);
  end();
  expect_the_whole_run();
}

TEST_F(JudgedSession, TakesACommandThatOvertookItsState) {
  for (std::int64_t k = 0; k <= last; ++k) command(k), state(k);
  end();
  expect_the_whole_run();
}

TEST_F(JudgedSession, WaitsForTheLastCommandThatTheEndOvertook) {
  ticks(0, last);
  state(last);
  EXPECT_FALSE(judge.ended());
  end();
  EXPECT_TRUE(judge.ended());
  EXPECT_FALSE(judge.over());
  command(last);
  expect_the_whole_run();
}

TEST_F(JudgedSession, CountsATickWhoseCommandWasLost) {
  ticks(0, last - 50);
  state(last - 50);
  ticks(last - 49, last + 1);
  end();
  EXPECT_FALSE(judge.over()) << "it may still come";
  const Result result = judge.finish(false, 0);
  EXPECT_EQ(result.missing_ticks, 1);
  EXPECT_TRUE(result.run->measures.trajectory_sha256.empty());
}

TEST_F(JudgedSession, HearsNothingOfOtherSessions) {
  command(0, kJudgedSession + 1);
  for (std::int64_t k = 0; k <= last; ++k) state(k), command(k, kJudgedSession + 1), command(k);
  end();
  expect_the_whole_run();
}

}  // namespace
}  // namespace mixloop
