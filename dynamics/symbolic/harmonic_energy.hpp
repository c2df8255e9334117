// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "dynamics/scene/scene.hpp"
#include "dynamics/symbolic/expression.hpp"
#include "dynamics/symbolic/harmonic_sum.hpp"

namespace mixloop {

/// Kinetic energy 1/2 psid^T M psid and potential of a scene as harmonic sums.
struct HarmonicEnergy {
  HarmonicSpace space;
  std::vector<Expression> atoms;            ///< powers n, n + 1, ...: numbers that depend on parameters
  std::vector<std::vector<HarmonicSum>> M;  ///< M[k][l], l <= k
  HarmonicSum potential;
  std::vector<std::vector<DoubleDouble>>
      axes;  ///< rates (rows in psi) of joints and of sums of parallel ones
};

/// nullopt where the scene is none of that kind (coordinates that are not affine in psi, with constant
/// coefficients, or depend on time; angles that depend on parameters) or would take too many terms. Used
/// while a Recording lives.
std::optional<HarmonicEnergy> harmonic_energy(const std::shared_ptr<const Scene>& scene, Graph& graph);

}  // namespace mixloop
