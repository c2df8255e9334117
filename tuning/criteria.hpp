// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stability/survey.hpp"
#include "sweep/outcome.hpp"

namespace mixloop {

/// What `mixloop stability --json` tells of a loop, along the path where it looks along one, else at its
/// start.
struct Margin {
  enum class Kind : std::uint8_t {
    spectral_radius,
    longest_tick,
    longest_delay,
    longest_tick_without_delay,
    longest_rk4_step,
    fastest_pole,
    gain_margin_most,
    gain_margin_least,
    gain_margin_of_motor
  };
  Kind kind = Kind::spectral_radius;
  std::size_t motor = 0;  ///< of gain_margin_of_motor

  bool is_along_path() const { return kind <= Kind::longest_delay; }
};

/// Of one instant's loop, an along-path margin; infinite where there is no limit, or where it is known to be
/// none of a path that has one of `narrowest` elsewhere.
double margin_at(const Margin& margin, const LinearLoop& loop, const Sampling& sampling, double narrowest);
/// Of the start's limits, one of the others.
double margin_at_start(const Margin& margin, const Limits& limits);

/// All that can be asked of a candidate, a number each in SI: what is measured of a run, then its margins.
class Criteria {
 public:
  struct Criterion {
    std::string name, unit;
    std::optional<Margin> margin;  ///< else it is measured
  };

  Criteria(const Columns& columns, const Experiment& experiment);

  std::size_t size() const { return all_.size(); }
  const Criterion& operator[](std::size_t i) const { return all_[i]; }
  /// Those that a name means: one, or with `max_torque` one a motor. Throws InputError("unknown_value") at
  /// `place` with the nearest name.
  std::vector<std::size_t> named(const std::string& name, const Place& place) const;

 private:
  std::vector<Criterion> all_;
};

}  // namespace mixloop
