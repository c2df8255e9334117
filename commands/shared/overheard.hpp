// SPDX-License-Identifier: MIT
#pragma once

#include <future>

#include "loop/result.hpp"
#include "runtime/bus/bus.hpp"
#include "runtime/clock/stop_switch.hpp"

namespace mixloop {

/// Judges a stranger's plant by what is heard of it (attached.hpp), in a thread of its own, while `mixloop
/// run` attends to the others.
class Overheard {
 public:
  /// Listens from now on. What is passed must outlive it.
  Overheard(const Experiment& experiment, const BusOptions& bus, nanoseconds first_wait,
            nanoseconds patience);
  ~Overheard() { over_.turn(); }
  Overheard(const Overheard&) = delete;
  Overheard& operator=(const Overheard&) = delete;

  /// What was heard until now, or until the plant's END. Throws RunFault("lost_peer") where no plant was.
  Result finish();

 private:
  StopSwitch over_;
  std::future<Result> result_;  ///< waits, when it is destroyed
};

}  // namespace mixloop
