// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

#include "sweep/go_through.hpp"

namespace mixloop {

/// How far a sweep or a search is, how fast, and how long it will take: on a terminal a line that is redrawn,
/// elsewhere one a minute; nothing of what is over within half a second.
class ShownSweep {
 public:
  /// `what`: what it counts, e.g. runs.
  ShownSweep(std::string name, bool quiet, std::string what = "runs");
  ~ShownSweep();
  ShownSweep(const ShownSweep&) = delete;
  ShownSweep& operator=(const ShownSweep&) = delete;

  /// `more`: what stands behind it.
  void at(const SweepProgress& progress, const std::string& more = "");
  /// A line that stays, also where it is quiet.
  void say(const std::string& text);

 private:
  std::string name_, what_;
  bool quiet_, on_terminal_, drawn_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace mixloop
