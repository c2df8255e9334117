// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "dynamics/symbolic/evaluation_angles.hpp"

namespace mixloop {

/// What is found once for a scene: see Writing for what is left to choose.
struct HarmonicScene {
  HarmonicEnergy energy;
  EvaluationAngles angles;
  std::vector<BlockForm> forms;
};

/// How the same equations may be written down; the tracer tries and keeps the cheapest.
struct Writing {
  std::size_t basis = 0;
  std::vector<std::size_t> phase;  ///< of each evaluation angle, which of those worth it
  bool reverse_gradient = true;    ///< of the Horner scheme; else a scheme of the gradient
  bool squared_sine = true;        ///< s^2 = 1 - c^2; else c^2 = 1 - s^2
  bool collected = true;           ///< Christoffel terms of a function collected; else as (A y)(f' y)
};

}  // namespace mixloop
