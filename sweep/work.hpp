// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <vector>

#include "sweep/outcome.hpp"
#include "sweep/runs.hpp"

namespace mixloop {

/// The runs that are to be done, who has which of them in hand, and what becomes of them. Threads share it.
class Work {
 public:
  using Keep = std::function<void(std::span<const Outcome>)>;

  /// `keep`: where outcomes go, one after the other.
  Work(Dispenser dispenser, Keep keep);

  /// Some for process `who`; none where all are handed out.
  Runs take(int who);
  /// Some for a thread of this process, 0: waits while others have some that may come back. None where all
  /// are done, or it is stopped.
  Runs take_or_wait();
  /// What it had in hand, or the first of them. What was taken from it meanwhile is passed over.
  void bring(int who, std::span<const Outcome> outcomes);
  /// What it has in hand is handed out again; how many they are.
  std::int64_t lose(int who);
  void stop();

  bool is_done() const;
  std::int64_t total() const { return total_; }
  std::int64_t done() const;

 private:
  struct InHand {
    int who = 0;
    Runs runs;
  };
  Runs taken(int who);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Dispenser dispenser_;
  Keep keep_;
  std::int64_t total_, done_ = 0;
  std::vector<InHand> in_hand_;
  std::vector<Runs> again_;
  bool stopped_ = false;
};

}  // namespace mixloop
