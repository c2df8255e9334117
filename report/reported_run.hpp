// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "loop/experiment.hpp"
#include "report/curves.hpp"
#include "report/log_run.hpp"

namespace mixloop {

/// How runs are read.
struct ReadOptions {
  std::string prefix = "MIXLOOP_";         ///< of a log's channels
  std::int64_t session = 0;                ///< of a log; 0: the one with the most states
  std::optional<Experiment> experiment;    ///< of a log that has no inputs.json beside it
  std::size_t capacity = std::size_t{1} << 15;  ///< buckets a curve, see Envelope
};

/// A run as a report shows it.
struct ReportedRun {
  std::string label, source;
  bool from_log = false;
  nlohmann::ordered_json result, inputs;  ///< as kept; null where there is none
  std::shared_ptr<const Scene> scene;     ///< null where none is known
  double rate_hz = 0;
  std::int64_t first_tick = 0;
  std::size_t n = 0, m = 0;
  Curves curves;
  std::optional<LogFacts> log;
  std::vector<std::string> notes;  ///< what a reader must know of where the numbers come from
};

/// Reads a folder that --out kept (result.json, trajectory.csv, and of run.lcmlog the ages of commands), or a
/// log of ours or of lcm-logger. Throws InputError for what is neither.
ReportedRun read_run(const std::filesystem::path& path, const ReadOptions& options);

}  // namespace mixloop
