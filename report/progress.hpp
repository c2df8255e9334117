// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace mixloop {

/// A line on the terminal that says how far some work is, redrawn a few times a second; silent where stderr
/// is no terminal and for work that is over within half a second.
class Progress {
 public:
  /// `per_unit` of them make a `unit`, in which the line counts.
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

}  // namespace mixloop
