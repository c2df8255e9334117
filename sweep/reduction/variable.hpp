// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "sweep/kept_sweep.hpp"
#include "sweep/reduction/axis.hpp"
#include "sweep/statistics.hpp"

namespace mixloop {

/// What a sweep's runs differ in: an entry that was varied or drawn, a column that was measured, or whether a
/// run was held.
struct Variable {
  enum class Kind : std::uint8_t { drawn, listed, words, measured, held };

  std::string name;
  std::string unit;  ///< of an entry as it was written, else SI; empty of a mere number
  Kind kind = Kind::measured;
  std::vector<std::string> words{};  ///< of those that are no numbers
  bool least_is_worst = false;       ///< the earlier a run diverges, the worse

  ColumnStatistics statistics{};  ///< of words: of their numbers
  Axis axis{};                    ///< of its histogram
  std::vector<std::int64_t> histogram{};

  bool is_entry() const { return kind <= Kind::words; }
  bool is_measured() const { return statistics.measured > 0; }
  bool varies() const { return statistics.least < statistics.most; }
};

/// The entries in their order, the columns, and last whether it was held.
std::vector<Variable> variables_of(const KeptSweep& sweep);

/// A run as numbers in their order: of whether it was held 0, else 1.
class VariableReader {
 public:
  explicit VariableReader(const KeptSweep& sweep) : design_(&sweep.design) {}
  /// The outcome with its values before and behind it; until the next one is read.
  const Outcome& read(const Outcome& outcome);

 private:
  const Design* design_;
  Outcome read_;
};

}  // namespace mixloop
