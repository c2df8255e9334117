// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

namespace mixloop {

/// No later tick is believed, so that no sum of ticks or microseconds overflows, from 1 Hz on.
inline constexpr std::int64_t kFarthestTick = 4'000'000'000'000;

/// Plant time of a tick in us, tick / rate rounded down, as messages carry it. Exact for rates in whole Hz,
/// however late the tick: whole seconds are split off first, since 1e6 tick would be rounded from 2^33 on.
inline std::int64_t plant_time_us(std::int64_t tick, double rate_hz) {
  double seconds = std::floor(static_cast<double>(tick) / rate_hz);
  double rest = std::fma(-seconds, rate_hz, static_cast<double>(tick));  // ticks, exact
  if (rest < 0) seconds -= 1, rest += rate_hz;
  const double us = std::floor(1e6 * rest / rate_hz);
  return 1'000'000 * static_cast<std::int64_t>(seconds) + static_cast<std::int64_t>(us);
}

}  // namespace mixloop
