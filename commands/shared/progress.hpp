// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "notation/long_work.hpp"
#include "runtime/clock/stop_switch.hpp"

namespace mixloop {

/// A line on the terminal that says how far some work is, redrawn a few times a second; silent where stderr
/// is no terminal and for work that is over within half a second.
class Progress {
 public:
  /// `per_unit` of them make a `unit`, in which the line counts; without a unit it tells the share alone.
  Progress(std::string name, std::int64_t ticks, double per_unit, std::string unit = "s");
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void at(std::int64_t tick);
  void clear();

 private:
  std::string name_;
  std::int64_t ticks_;
  double per_unit_;
  std::string unit_;
  bool on_terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point next_;
};

/// While it lives, this thread's long work is shown as by Progress, and ended by Interrupted once the switch
/// is turned.
class ShownWork {
 public:
  explicit ShownWork(const StopSwitch& stop)
      : watch_([&stop] { return stop.turned(); },
               [this](const char* what, std::int64_t done, std::int64_t of) { hear(what, done, of); }) {}

 private:
  void hear(const char* what, std::int64_t done, std::int64_t of);

  const char* what_ = nullptr;
  std::optional<Progress> progress_;  ///< of `what_`
  int unheard_ = 0;                   ///< steps since it was last told
  WorkWatch watch_;
};

}  // namespace mixloop
