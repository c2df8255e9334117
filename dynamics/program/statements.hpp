// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "dynamics/program/affine_angles.hpp"
#include "dynamics/program/program.hpp"

namespace mixloop {

/// One node of a program, or the sines and cosines of a batch of angles.
struct Statement {
  NodeId node = 0;
  std::vector<NodeId> batch;
  std::vector<AffineAngle> angles = {};  ///< of the batch, where all of it is written_angle
};

/// A program in the order in which it is written down: angles first, so that their sines and cosines are
/// under way early, up to four together.
class Statements {
 public:
  explicit Statements(const Program& program);

  std::vector<Statement> of(Program::Stage stage) const;
  std::vector<NodeId> takes(const Statement& statement) const;
  std::vector<NodeId> gives(const Statement& statement) const;
  /// The sine and the cosine of an angle, those that there are.
  const std::vector<NodeId>& pair_of(NodeId angle) const { return pairs_[angle]; }

 private:
  std::vector<Statement> angle_batches(Program::Stage stage) const;
  std::vector<AffineAngle> written_together(const std::vector<NodeId>& batch) const;
  std::vector<bool> inside_angles(const std::vector<Statement>& batches) const;
  std::vector<NodeId> with_operands(NodeId root, Program::Stage stage, const std::vector<bool>& taken) const;

  const Program& program_;
  std::vector<std::vector<NodeId>> pairs_;
};

}  // namespace mixloop
