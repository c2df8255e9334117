// SPDX-License-Identifier: MIT
// This text also goes into every kernel of closed loops, so it stands alone: C++17.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "notation/functions/fused.hpp"

namespace mixloop {

/// What a random number is drawn for: each has numbers of its own.
enum class Draw : std::uint64_t {
  noise,
  drop,
  motor_fault,
  position_fault,
  velocity_fault,
  sample,       ///< of a sweep, whose runs stand for ticks
  permutation,  ///< of its strata
  scramble      ///< of its points
};

/// Random numbers as a function of seed, tick, channel and what they are for: whoever draws them, in whatever
/// order and however often, gets the same ones.
class Chance {
 public:
  MIXLOOP_INLINE explicit Chance(std::uint64_t seed = 0) : seed_(mixed(seed)) {}
  bool operator==(const Chance& other) const { return seed_ == other.seed_; }

  /// Uniform in [0, 1).
  MIXLOOP_INLINE double uniform(std::int64_t tick, std::size_t channel, Draw draw) const {
    return 0x1p-53 * static_cast<double>(bits(tick, channel, draw, 0) >> 11);
  }

  /// Normal, mean 0, standard deviation 1. Box & Muller, A note on the generation of random normal deviates,
  /// 1958.
  MIXLOOP_INLINE double normal(std::int64_t tick, std::size_t channel, Draw draw) const {
    const double u = 0x1p-53 * (static_cast<double>(bits(tick, channel, draw, 0) >> 11) + 0.5);  // in (0, 1)
    const double v = 0x1p-53 * static_cast<double>(bits(tick, channel, draw, 1) >> 11);
    constexpr double kTurn = 0x1.921fb54442d18p+2;
    return std::sqrt(-2 * std::log(u)) * std::cos(kTurn * v);
  }

  /// 64 random bits; `index`: 0 or 1.
  MIXLOOP_INLINE std::uint64_t bits(std::int64_t tick, std::size_t channel, Draw draw,
                                    std::uint64_t index = 0) const {
    const std::uint64_t which =
        (static_cast<std::uint64_t>(channel) << 8) | (static_cast<std::uint64_t>(draw) << 1) | index;
    return mixed(mixed(seed_ + static_cast<std::uint64_t>(tick)) + which);
  }

 private:
  /// A step of SplitMix64 (Steele, Lea & Flood, Fast splittable pseudorandom number generators, 2014).
  MIXLOOP_INLINE static std::uint64_t mixed(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  std::uint64_t seed_;
};

}  // namespace mixloop
