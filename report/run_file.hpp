// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "loop/experiment.hpp"
#include "report/log_run.hpp"

namespace mixloop {

/// How runs are read.
struct ReadOptions {
  std::string prefix = "MIXLOOP_";       ///< of a log's channels
  std::int64_t session = 0;              ///< of a log; 0: the one with the most states
  std::optional<Experiment> experiment;  ///< of a log that has no inputs.json beside it
};

/// A kept result or a log, opened.
struct RunFile {
  std::string label, source;  ///< printable
  bool from_log = false;      ///< its ticks come from a log, not from the plant's memory
  std::filesystem::path trajectory, log, ages;
  std::optional<LogSession> session;
  std::string prefix;
  nlohmann::ordered_json result, inputs;  ///< as kept; null where there is none
  std::shared_ptr<const Scene> scene;     ///< null where none is known
  std::vector<double> parameters;         ///< of the plant
  bool has_path = true;                   ///< as far as is known
  bool switches = false;                  ///< coordinates: psi doesn't say how the others stand
  double rate_hz = 0;
  std::int64_t first_tick = 0;
  RunSizes sizes;
  std::vector<std::string> notes;  ///< what a reader must know of where the numbers come from
};

/// Opens a folder that --out kept (result.json, trajectory.csv, and of run.lcmlog the ages of commands), or a
/// log of ours or of lcm-logger. What lies in the folder and is of another run is left out, and noted. Throws
/// InputError for what is neither.
RunFile open_run(const std::filesystem::path& path, const ReadOptions& options);

/// Calls `on_tick` for every tick, completed by the scene where one is known. What a log lacks is added to
/// the run's notes. Throws InputError, with its place, where the file is damaged.
std::optional<LogFacts> read_ticks(RunFile& run, const std::function<void(Tick&)>& on_tick);

}  // namespace mixloop
