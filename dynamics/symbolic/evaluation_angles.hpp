// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "dynamics/symbolic/harmonic_form.hpp"

namespace mixloop {

/// The angles whose sine and cosine an evaluation computes, and how every harmonic is a small whole
/// combination of them.
struct EvaluationAngles {
  using Angle = std::array<std::int16_t, kMostBaseAngles>;

  std::vector<Angle> angles;
  std::vector<std::vector<DoubleDouble>> phases;  ///< of each angle: constants worth adding to it; 0 first
  std::map<Angle, std::vector<int>> combinations;
};

/// The fewest angles in which the energy's harmonics are combinations of low degree; nullopt where that would
/// take too many.
std::optional<EvaluationAngles> evaluation_angles(const HarmonicEnergy& energy);

}  // namespace mixloop
