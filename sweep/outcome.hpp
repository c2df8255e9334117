// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "loop/result.hpp"

namespace mixloop {

/// How a run of a sweep ended: beside a run's own verdicts, `refused` is one that can't be run with its
/// values.
enum class RunEnd : std::uint8_t { held, missed, diverged, safe_state, fault, refused };
std::string_view name_of(RunEnd end);
inline constexpr std::size_t kRunEnds = 6;

/// What became of a run.
struct Outcome {
  std::int64_t run = 0;
  RunEnd end = RunEnd::held;
  std::string code;            ///< of the error, where there was one
  std::vector<double> values;  ///< of the Columns; what was never measured is not a number
  std::string sha256;          ///< of the trajectory, where it was asked for

  bool operator==(const Outcome&) const = default;
};

/// To the bit; what was never measured is the same as itself.
bool are_same(const Outcome& a, const Outcome& b);

/// What is told of each run of an experiment, a number each in SI.
class Columns {
 public:
  struct Column {
    std::string name, unit;
  };
  /// `settles`: when it has settled is told.
  Columns(const Experiment& experiment, bool settles);

  std::size_t size() const { return all_.size(); }
  const Column& operator[](std::size_t i) const { return all_[i]; }
  const std::vector<Column>& all() const { return all_; }
  /// Of a run, or of one that never was.
  std::vector<double> values(const Measures& measures) const;
  /// Back: what bounds are held to.
  Measures measures(const Outcome& outcome) const;

 private:
  template <class Passed, class Take>
  void go(Passed& measures, const Take& take) const;

  bool follows_path_, is_oriented_, is_of_motors_, settles_, closed_, switches_;
  std::size_t n_, n_u_;
  std::vector<Column> all_;
};

}  // namespace mixloop
