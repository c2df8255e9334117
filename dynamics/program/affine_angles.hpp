// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "dynamics/program/program.hpp"

namespace mixloop {

/// An angle as constant + sum of factor * psi[index], indices ascending.
struct AffineAngle {
  double constant = 0;
  std::vector<std::pair<NodeId, double>> terms;
};

/// The angle at a node, where it is of that kind with up to four terms, and more than a coordinate as it is.
/// Factors are worked out in DoubleDouble and rounded once.
std::optional<AffineAngle> affine_angle(const Program& program, NodeId angle);

/// The same where it is also written as fma(psi[j], factor_j, ... fma(psi[i], factor_i, constant)), i < j,
/// with nothing else in between.
std::optional<AffineAngle> written_angle(const Program& program, NodeId angle);

}  // namespace mixloop
