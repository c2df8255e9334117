// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <type_traits>

#include "sweep/outcome.hpp"
#include "sweep/setup.hpp"

namespace mixloop {

/// What is told of runs.
struct Telling {
  Columns columns;
  std::optional<double> settled_within;  ///< m
  bool hashes = false;  ///< the trajectories' SHA-256, for which they are kept while they run
};

/// Goes through runs that have been prepared, experiments equal but for their numbers, and says what became
/// of each, in their order. Threads have one at once. Every engine gives the same bytes.
class Engine {
 public:
  static constexpr std::int64_t kTogether = 8;  ///< runs that lanes take at once

  using Go = std::function<std::vector<Outcome>(std::span<const PreparedRun> runs, const Telling& telling)>;

  /// Of a function, or of what says by batch() how many runs it wants at a time, where there are so many.
  template <class Runner>
  requires(std::is_constructible_v<Go, Runner> && !std::is_same_v<Runner, Engine>) Engine(Runner runner) {
    if constexpr (requires { runner.batch(); }) batch_ = runner.batch();
    go_ = std::move(runner);
  }

  std::vector<Outcome> operator()(std::span<const PreparedRun> runs, const Telling& telling) const {
    return go_(runs, telling);
  }
  std::int64_t batch() const { return batch_; }

 private:
  Go go_;
  std::int64_t batch_ = 1;
};

/// What is told of a run of which this was measured.
Outcome outcome_of(const PreparedRun& run, const Measures& measures, const Telling& telling);

/// One run after the other, as `mixloop simulate` does it.
std::vector<Outcome> run_one_by_one(std::span<const PreparedRun> runs, const Telling& telling);

/// Makes a run ready; throws InputError where it can't be run.
using Prepare = std::function<PreparedRun(std::int64_t run)>;

/// Runs `first` to `first` + `count` - 1 of a sweep, prepared and gone through; those that can't be prepared
/// are refused. Fewer where `goes_on` says so.
std::vector<Outcome> run_batch(const Prepare& prepare, const Telling& telling, const Engine& engine,
                               std::int64_t first, std::int64_t count, const std::function<bool()>& goes_on);
std::vector<Outcome> run_batch(const Setup& setup, const Telling& telling, const Engine& engine,
                               std::int64_t first, std::int64_t count, const std::function<bool()>& goes_on);

}  // namespace mixloop
