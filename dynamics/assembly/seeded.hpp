// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <random>

namespace mixloop {

/// Numbers drawn from [-1, 1), the same on every machine.
class Seeded {
 public:
  explicit Seeded(std::uint64_t seed) : generator_(seed) {}
  double draw() { return static_cast<double>(generator_() >> 11) * 0x1p-52 - 1.0; }

 private:
  std::mt19937_64 generator_;
};

}  // namespace mixloop
