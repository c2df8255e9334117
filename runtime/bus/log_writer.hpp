// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "runtime/bus/bus.hpp"

namespace mixloop {

/// What a log holds. It is no record of truth: a full queue drops messages, and `missing_ticks` says how many
/// ticks of the plant have no STATE in it.
struct LogSummary {
  std::int64_t events = 0;
  std::int64_t missing_ticks = 0;
};

/// Records every channel of the bus into an LCM log file (as lcm-logger does) from a thread of its own.
class LogWriter {
 public:
  /// Throws RunFault("cannot_write") or what Bus throws.
  LogWriter(const BusOptions& bus, const std::filesystem::path& file);
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// Drains what has arrived and closes the file. Throws RunFault("cannot_write") where not all of it is
  /// written.
  LogSummary finish();

 private:
  struct Recording;
  std::unique_ptr<Recording> recording_;
};

}  // namespace mixloop
