// SPDX-License-Identifier: MIT
#include <unistd.h>

#include <array>
#include <condition_variable>
#include <deque>
#include <mutex>

#include "sweep/crew.hpp"
#include "sweep/folder.hpp"
#include "sweep/journal.hpp"
#include "sweep/leading.hpp"
#include "sweep/peer_words.hpp"

namespace mixloop {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kPause(1);

/// Between the threads that go through runs and the one that knows the other processes.
class Trays {
 public:
  Runs next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_ || !work_.empty(); });
    if (closed_) return {};
    const Runs runs = work_.front();
    work_.pop_front();
    return runs;
  }
  void put(const Runs& runs) {
    const std::lock_guard lock(mutex_);
    work_.push_back(runs);
    changed_.notify_one();
  }
  /// What is begun is brought, and no more.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }
  void bring(const std::vector<Outcome>& outcomes) {
    if (outcomes.empty()) return;
    const Runs runs{outcomes.front().run, std::ssize(outcomes)};
    const std::lock_guard lock(mutex_);
    brought_.push_back(message_of(PeerWord::brought, bytes_of(runs) + bytes_of(outcomes)));
  }
  std::deque<std::string> brought() {
    const std::lock_guard lock(mutex_);
    return std::exchange(brought_, {});
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Runs> work_;
  std::deque<std::string> brought_;
  bool closed_ = false;
};

}  // namespace

bool follow(Peers& peers, const Sweep& sweep, const Engine& engine, int threads,
            const std::function<bool()>& goes_on, std::chrono::milliseconds patience) {
  static constexpr int kAhead = 2;  // a thread has the next ones before it has brought the last
  Trays trays;
  std::atomic<bool> stopped{false};
  peers.send(0, message_of(PeerWord::hello, sweep.sha256() + own_name()));
  for (int i = 0; i < kAhead * threads; ++i) peers.send(0, message_of(PeerWord::ready));
  Crew crew(sweep.setup(), sweep.telling(), engine, threads,
            {.next = [&] { return trays.next(); },
             .brought = [&](const std::vector<Outcome>& outcomes) { trays.bring(outcomes); },
             .goes_on = [&] { return !stopped; }});
  // Whatever ends this, the threads end with what they have begun.
  const struct Close {
    Trays& trays;
    ~Close() { trays.close(); }
  } close{trays};
  bool told = false;
  auto beat = Clock::now(), heard = beat;
  for (;;) {
    while (const auto message = peers.receive()) {
      heard = Clock::now();
      std::string_view rest = std::string_view(message->text).substr(1);
      const auto word = static_cast<PeerWord>(message->text.front());
      if (word == PeerWord::work) trays.put(runs_in(rest));
      if (word == PeerWord::stop) stopped = true;
      if (word == PeerWord::end) return rest == "1";
    }
    if (Clock::now() - heard > patience) return false;  // who leads has gone
    if (!goes_on()) stopped = true;
    if (stopped) trays.close();
    bool over = false;
    try {
      over = crew.ended_within(kPause);
      if (over) std::this_thread::sleep_for(kPause);
    } catch (const std::exception& failure) {
      peers.send(0, message_of(PeerWord::failed, failure.what()));
      return false;
    }
    for (auto& message : trays.brought()) peers.send(0, std::move(message));
    if (over && !std::exchange(told, true)) peers.send(0, message_of(PeerWord::done));
    if (Clock::now() - beat < kBeat) continue;
    beat = Clock::now();
    peers.send(0, message_of(PeerWord::alive));
  }
}

}  // namespace mixloop
