// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

#include "sweep/go_through.hpp"

namespace mixloop {

/// How far a sweep is, how fast, and how long it will take: on a terminal a line that is redrawn, elsewhere
/// one a minute; nothing of what is over within half a second.
class ShownSweep {
 public:
  ShownSweep(std::string name, bool quiet);
  ~ShownSweep();
  ShownSweep(const ShownSweep&) = delete;
  ShownSweep& operator=(const ShownSweep&) = delete;

  void at(const SweepProgress& progress);
  /// A line that stays, also where it is quiet.
  void say(const std::string& text);

 private:
  std::string name_;
  bool quiet_, on_terminal_, drawn_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace mixloop
