// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "stability/sampled_loop.hpp"

namespace mixloop {

/// Where a loop at one reference stops being stable, one thing changed at a time. Empty: not within the range
/// searched (ticks to 100 times the sampling's, delays to 20 ticks, gains from 1/1000 to 1000 times). 0: none
/// is short enough.
struct Limits {
  double fastest_pole = 0;             ///< 1/s: real part of the largest pole, control at every instant
  double radius = 0;                   ///< spectral radius a tick at the sampling in hand
  std::optional<double> longest_tick;  ///< s, at the delay in hand
  std::optional<double> longest_tick_undelayed;  ///< s, without delay
  std::optional<double> longest_delay;           ///< s, at the tick in hand
  std::optional<double> longest_rk4_step;        ///< s, control at every stage
  std::optional<double> most_gain,
      least_gain;  ///< factors on all of Kp and Kv; no least: stable without them
  std::vector<std::optional<double>> most_gain_of_motor;  ///< n_u: on a motor's own
};

/// For whoever seeks the least of several limits: as far as there is no need to look.
constexpr double kFarEnough = std::numeric_limits<double>::infinity();

Limits limits_of(const LinearLoop& loop, const Sampling& sampling);

/// The longest tick, s, at which the loop is stable with this delay, looking on from a hundredth of `tick`; 0
/// where none is short enough, empty where 100 of it aren't too long, or it is known to be `enough` or more.
std::optional<double> longest_tick(const LinearLoop& loop, double delay, double tick,
                                   double enough = kFarEnough);

/// The longest delay at which the loop is stable with this tick, s; 0 where it isn't without one, empty where
/// 20 ticks aren't too long, or it is known to be `enough` or more. Looks every `step` of a second: narrower
/// gaps are not seen.
std::optional<double> longest_delay(const LinearLoop& loop, double tick, double step,
                                    double enough = kFarEnough);

/// The first x, going on from `start` by `next`, where `radius` passes 1 (see grows), to 1e-7 of it by
/// bisection; empty where it doesn't up to `end`, or on the way up to a look at or past `enough`. `start`
/// itself where it is unstable there.
std::optional<double> first_unstable(const std::function<double(double)>& radius, double start, double end,
                                     const std::function<double(double)>& next, double enough = kFarEnough);

}  // namespace mixloop
