// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "sweep/engine.hpp"
#include "sweep/runs.hpp"

namespace mixloop {

/// Threads that go through the runs of a sweep, as long as there are some. Whoever has it looks after what
/// they bring in the meantime.
class Crew {
 public:
  /// What it asks for and brings, several threads at a time.
  struct Hands {
    std::function<Runs()> next;  ///< waits for some; none: there are no more
    std::function<void(const std::vector<Outcome>&)> brought;
    std::function<bool()> goes_on;  ///< false: what is begun is brought, and no more
  };

  Crew(const Setup& setup, const Telling& telling, const Engine& engine, int threads, Hands hands);
  /// Waits for its threads.
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  /// Waits so long, or until all threads have ended; once they have, at once. Whether they have; rethrows
  /// what ended one of them, as soon as it has.
  bool ended_within(std::chrono::milliseconds time);

 private:
  void work();

  const Setup& setup_;
  const Telling& telling_;
  const Engine& engine_;
  Hands hands_;
  std::mutex state_;
  std::condition_variable changed_;
  int at_work_;
  std::exception_ptr failure_;
  std::atomic<bool> failed_{false};
  std::vector<std::jthread> threads_;
};

}  // namespace mixloop
