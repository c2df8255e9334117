// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "processes/command_line.hpp"
#include "sweep/request.hpp"

namespace mixloop {

/// What `sweep` and `tune` share: an experiment's file or a sweep's, and what its runs vary.
struct RunsLine : CommonOptions {
  std::string file, case_name;
  std::vector<std::string> vary, sample;
  std::optional<std::int64_t> runs;
  std::optional<std::uint64_t> seed;
  std::string design, settled_within;
  int threads = 0;  ///< runs at a time; 0: not said
  Evaluation evaluation = Evaluation::machine_code;
};

/// An option that may be repeated, a word each time.
void add_list_option(CLI::App& command, const char* name, std::vector<std::string>& list, const char* what,
                     const char* type);

/// `draws`: how many are drawn unless the line says so.
void add_runs_options(CLI::App& command, RunsLine& line, std::int64_t draws);

/// How many runs at a time: as many as the line says, else one a core.
int threads_of(const RunsLine& line);

/// What the file asks for, if it is a sweep's, with what the line says on top. Throws InputError.
SweepRequest request_of(RunsLine& line);

}  // namespace mixloop
