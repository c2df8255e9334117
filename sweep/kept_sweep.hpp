// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sweep/sweep.hpp"

namespace mixloop {

/// A sweep as its folder tells of it: enough to read its runs and to name their values, without the
/// experiment's files.
struct KeptSweep {
  std::string name, called;  ///< the command line that asks for it
  std::filesystem::path experiment;
  std::vector<Override> overrides;  ///< of all runs
  Design design;
  std::string spread;  ///< of what is drawn: "latin"; empty where nothing is
  std::uint64_t seed = 1;
  std::vector<Columns::Column> columns;
  std::string sha256;  ///< of its journals

  /// The command that goes through a run alone: Sweep::command.
  std::string command(std::int64_t run) const;
};

/// Whether a folder is, or was meant to be, that of a sweep.
bool is_sweep_folder(const std::filesystem::path& folder);

/// Reads a folder's `asked.yaml`. Throws InputError: "no_such_file" where there is none, and what is wrong
/// with it.
KeptSweep read_kept_sweep(const std::filesystem::path& folder);

/// Writes it. Throws RunFault("cannot_write").
void write_kept_sweep(const std::filesystem::path& folder, const Sweep& sweep);

}  // namespace mixloop
