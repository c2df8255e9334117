// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "notation/keys.hpp"
#include "sweep/design.hpp"

namespace mixloop {

/// A bound on a share of a sweep's runs.
struct ShareBound {
  double share = 1;  ///< so many of them at least, 0 to 1
  NodePtr expected;  ///< hold this: an experiment's `expect`, without `share`
  Place place;
};

/// What a sweep is to do: what its command line says, or its file.
struct SweepRequest {
  std::string called;  ///< the command line that asks for it, without where it is kept and by whom it is run
  std::filesystem::path experiment;
  std::vector<Override> overrides;  ///< of all runs
  Design::Settings design;
  bool draws_given = false, spread_given = false;
  std::optional<double> settled_within;  ///< m
  std::vector<ShareBound> expect;
};

/// Keys of a sweep's file, and of what it expects.
const Keys& sweep_keys();
const Keys& sweep_expectation_keys();

/// Whether a file is a sweep's, not an experiment's: a mapping with the key `experiment`. False also where it
/// can't be read.
bool is_sweep(const std::filesystem::path& file);

/// What it is called: its stem, without `.sweep`; printable.
std::string name_of_sweep(const std::filesystem::path& file);

/// Reads a sweep's file. Throws InputError.
SweepRequest read_sweep(const std::filesystem::path& file);

/// Throws InputError where `runs` or `design` is given and nothing is sampled.
void require_samples(const SweepRequest& request);

/// `latin`, `sobol`, `random`, or `grid`, which is none of these.
std::optional<Spread> spread_named(const std::string& name);
const std::vector<std::string>& spread_names();

}  // namespace mixloop
