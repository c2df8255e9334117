// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

namespace mixloop {

/// Asks a waiting loop for an ordered stop. Turned by a signal handler or from any thread; a loop that polls
/// `fd()` wakes at once, so that no signal is lost between its check and its wait.
class StopSwitch {
 public:
  StopSwitch();
  ~StopSwitch();
  StopSwitch(const StopSwitch&) = delete;
  StopSwitch& operator=(const StopSwitch&) = delete;

  /// Lets SIGINT, SIGTERM and, unless it is ignored (nohup), SIGHUP turn this switch until it is destroyed;
  /// one switch a process can do so.
  void turn_on_signals();
  /// Safe in a signal handler. `signal` is what asked for it, 0 if no signal did.
  void turn(int signal = 0) noexcept;

  bool turned() const noexcept { return turned_.load(std::memory_order_relaxed); }
  int signal() const noexcept { return signal_.load(std::memory_order_relaxed); }
  int fd() const noexcept { return fd_; }  ///< readable once turned

 private:
  int fd_;
  std::atomic<bool> turned_{false};
  std::atomic<int> signal_{0};
  bool has_signals_ = false;
};

}  // namespace mixloop
