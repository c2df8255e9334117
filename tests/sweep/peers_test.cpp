// SPDX-License-Identifier: MIT
// Several processes at one sweep, as threads here: nobody's end loses or doubles a run.
#include <gmock/gmock.h>

#include <deque>

#include "sweep/go_through.hpp"
#include "sweep/peer_words.hpp"
#include "sweep/table.hpp"
#include "tests/support/command.hpp"

namespace mixloop {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;

/// What all of them have said to each other, and not heard yet.
struct Post {
  std::mutex mutex;
  std::map<int, std::deque<Peers::Message>> to;
};

class PeerThread final : public Peers {
 public:
  PeerThread(Post& post, int rank, int size) : post_(post), rank_(rank), size_(size) {}
  int rank() const override { return rank_; }
  int size() const override { return size_; }
  void send(int to, std::string text) override {
    const std::lock_guard lock(post_.mutex);
    post_.to[to].push_back({rank_, std::move(text)});
  }
  std::optional<Message> receive() override {
    const std::lock_guard lock(post_.mutex);
    auto& mine = post_.to[rank_];
    if (mine.empty()) return std::nullopt;
    Message message = std::move(mine.front());
    mine.pop_front();
    return message;
  }
  void leave(bool together) override { left_ = together; }
  std::optional<bool> left() const { return left_; }

 private:
  Post& post_;
  int rank_, size_;
  std::optional<bool> left_;
};

class SweepPeers : public testing::Test {
 protected:
  using Follower = std::function<void(PeerThread&)>;

  std::string table(const SweepFolder& kept) const {
    const KeptRuns runs(kept.journals(), sweep.sha256(), sweep.telling().columns.size());
    const auto file = kept.path() / "table.csv";
    write_csv(file, sweep, [&](const auto& told) { runs.each(told); });
    return bytes_of(file.string());
  }

  /// The table that the leading one comes to with these.
  std::string led(const std::vector<Follower>& others, milliseconds patience = milliseconds(60'000)) {
    const ScratchFolder folder;
    const SweepFolder kept(folder.path(), sweep, {});
    Post post;
    const int size = static_cast<int>(others.size()) + 1;
    PeerThread leader(post, 0, size);
    std::vector<std::jthread> threads;
    for (int rank = 1; rank < size; ++rank)
      threads.emplace_back([&, rank] {
        PeerThread peer(post, rank, size);
        others[static_cast<std::size_t>(rank - 1)](peer);
      });
    go_through(sweep, kept, {},
               {.peers = &leader, .patience = patience, .said = [&](const std::string& text) {
                  said.push_back(text);
                }});
    together = leader.left();
    threads.clear();
    return table(kept);
  }
  std::string alone() { return led({}); }

  void work(PeerThread& peer) const {
    EXPECT_TRUE(follow(
        peer, sweep, run_one_by_one, 1, [] { return true; }, milliseconds(60'000)));
  }
  /// Takes some runs, and is never heard again.
  void die(PeerThread& peer) const {
    peer.send(0, message_of(PeerWord::hello, sweep.sha256() + "the one that dies"));
    for (int i = 0; i < 3; ++i) peer.send(0, message_of(PeerWord::ready));
  }

  const Sweep sweep = [] {
    SweepRequest request;
    request.experiment = MIXLOOP_EXPERIMENTS "/paper.yaml";
    request.overrides = {
        {"path", "{line: {from: [0.3, 0.0, 0.8], to: [0.299, 0.001, 0.799]}, duration: 0.01 s}"}};
    request.design.sampled = {parse_sampled("parameters.payload=normal(5 kg, 1 kg)")};
    request.design.draws = 300;
    return Sweep("test", request, Evaluation::interpreter, false);
  }();
  std::vector<std::string> said;
  std::optional<bool> together;
};

TEST_F(SweepPeers, ComeToTheSameTable) {
  const std::string whole = alone();
  EXPECT_TRUE(led({[&](PeerThread& peer) { work(peer); }, [&](PeerThread& peer) { work(peer); }}) == whole);
  EXPECT_EQ(together, true);
  EXPECT_THAT(said, ElementsAre());
}

TEST_F(SweepPeers, OneThatFallsSilentIsToldAndItsRunsAreDoneByOthers) {
  const std::string whole = alone();
  EXPECT_TRUE(led({[&](PeerThread& peer) { die(peer); }}, milliseconds(300)) == whole);
  EXPECT_EQ(together, false);
  EXPECT_THAT(said, ElementsAre(HasSubstr("rank 1 (the one that dies) has been silent for 0.3 s; the ")));
}

TEST_F(SweepPeers, OneOfAnotherSweepIsToldAndGetsNothing) {
  const std::string whole = alone();
  EXPECT_TRUE(led({[&](PeerThread& peer) {
                peer.send(0, message_of(PeerWord::hello, std::string(64, 'x') + "a stranger"));
                peer.send(0, message_of(PeerWord::ready));
              }}) == whole);
  EXPECT_THAT(said, ElementsAre(HasSubstr("rank 1 (a stranger) reads other files")));
}

TEST_F(SweepPeers, OneThatCanNotGoOnSaysWhy) {
  const Engine broken = [](std::span<const PreparedRun>, const Telling&) -> std::vector<Outcome> {
    throw std::runtime_error("out of paper");
  };
  const std::string whole = alone();
  EXPECT_TRUE(led({[&](PeerThread& peer) {
                EXPECT_FALSE(follow(
                    peer, sweep, broken, 1, [] { return true; }, milliseconds(60'000)));
              }}) == whole);
  EXPECT_THAT(said, ElementsAre(HasSubstr("can't go on: out of paper")));
}

// What was given up for lost and comes all the same is passed over.
TEST(SweepWork, WhatIsBroughtTwiceCountsOnce) {
  std::vector<std::int64_t> kept;
  Work work({without(4, {}), {2, 0, 1}}, [&](std::span<const Outcome> outcomes) {
    for (const auto& one : outcomes) kept.push_back(one.run);
  });
  const std::vector<Outcome> first = {{.run = 0}, {.run = 1}}, second = {{.run = 2}, {.run = 3}};
  EXPECT_EQ(work.take(1), (Runs{0, 2}));
  EXPECT_EQ(work.lose(1), 2);
  EXPECT_EQ(work.take(2), (Runs{0, 2}));
  work.bring(1, first);
  work.bring(2, first);
  EXPECT_EQ(work.take(2), (Runs{2, 2}));
  EXPECT_EQ(work.take(2), Runs());
  work.bring(2, second);
  EXPECT_TRUE(work.is_done());
  EXPECT_THAT(kept, ElementsAre(0, 1, 2, 3));
}

}  // namespace
}  // namespace mixloop
