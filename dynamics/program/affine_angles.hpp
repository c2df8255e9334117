// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "dynamics/program/program.hpp"
#include "dynamics/symbolic/double_double.hpp"

namespace mixloop {

/// An angle as constant + sum of factor * psi[index], indices ascending.
struct AffineAngle {
  double constant = 0;
  std::vector<std::pair<NodeId, double>> terms;
};

/// Which nodes of a program are such angles. Factors are worked out in DoubleDouble and rounded once.
class AffineAngles {
 public:
  explicit AffineAngles(const Program& program);

  /// The angle at a node, where it has up to four terms and is more than a coordinate as it is.
  std::optional<AffineAngle> at(NodeId angle) const;

 private:
  struct Sum {
    DoubleDouble constant;
    std::map<NodeId, DoubleDouble> terms;
    int height = 0;  ///< operations, one in another

    void add(const Sum& other, const DoubleDouble& factor);
  };
  std::optional<Sum> sum_of(const ExpressionNode& node) const;

  std::unordered_map<NodeId, Sum> sums_;
};

/// An angle that is written as fma(psi[j], factor_j, ... fma(psi[i], factor_i, constant)), i < j,
/// with nothing else in between.
std::optional<AffineAngle> written_angle(const Program& program, NodeId angle);

}  // namespace mixloop
