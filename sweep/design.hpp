// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "loop/experiment.hpp"
#include "sweep/permutation.hpp"
#include "sweep/sobol.hpp"
#include "sweep/variation.hpp"

namespace mixloop {

/// How drawn values are spread.
enum class Spread : std::uint8_t { latin, sobol, random };
std::string_view name_of(Spread spread);

/// The value that a varied entry has in a run.
struct RunValue {
  double number = 0;  ///< in the unit that was written; of texts: which one
  std::string text;   ///< as it is written into the experiment
};

/// What each run of a sweep sets. The runs go through all combinations of what is listed, the last entry
/// first, and at each of them through the same `draws` of what is drawn: run = combination * draws + draw.
/// A run's values are a function of seed and run alone.
class Design {
 public:
  struct Settings {
    std::vector<Variation> varied, sampled;
    std::int64_t draws = 1000;  ///< where something is drawn, else 1
    Spread spread = Spread::latin;
    std::uint64_t seed = 1;
  };

  /// Throws InputError: nothing or an entry twice is varied, or more than 10^12 runs.
  explicit Design(Settings settings);

  std::int64_t runs() const { return runs_; }
  /// What is listed, then what is drawn.
  const std::vector<Variation>& variations() const { return variations_; }
  std::size_t varied() const { return varied_; }  ///< how many of them are listed
  std::int64_t draws() const { return draws_; }   ///< 1 where nothing is drawn
  /// Which draw a run has.
  std::int64_t draw_of(std::int64_t run) const { return run % draws_; }

  /// What variations() are in a run, each a number (RunValue::number); `numbers` has their size.
  void numbers(std::int64_t run, std::span<double> numbers) const;
  std::vector<RunValue> values(std::int64_t run) const;
  /// As --set takes them.
  std::vector<Override> overrides(std::int64_t run) const;

 private:
  double drawn(std::int64_t draw, std::size_t dimension) const;

  std::vector<Variation> variations_;
  std::size_t varied_;  ///< of variations_
  std::int64_t draws_, runs_ = 1;
  Spread spread_;
  Chance chance_;
  std::optional<Sobol> sobol_;
  std::vector<Permutation> strata_;
};

}  // namespace mixloop
