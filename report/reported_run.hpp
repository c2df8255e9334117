// SPDX-License-Identifier: MIT
#pragma once

#include "report/curves.hpp"
#include "report/run_file.hpp"

namespace mixloop {

/// A run as a report shows it.
struct ReportedRun : RunFile {
  Curves curves;
  std::optional<LogFacts> facts;  ///< of its log, where it has one
};

/// Reads all ticks of a run; `capacity`: buckets a curve, see Envelope. Throws what open_run and read_ticks
/// throw.
ReportedRun read_run(const std::filesystem::path& path, const ReadOptions& options, std::size_t capacity);

}  // namespace mixloop
