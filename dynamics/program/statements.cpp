// SPDX-License-Identifier: MIT
#include "dynamics/program/statements.hpp"

#include <algorithm>

namespace mixloop {
namespace {

using Stage = Program::Stage;

bool is_trigonometric(Op op) { return op == Op::sin || op == Op::cos; }

}  // namespace

Statements::Statements(const Program& program) : program_(program), pairs_(program.nodes.size()) {
  for (NodeId id = 0; id < program.nodes.size(); ++id)
    if (is_trigonometric(program.nodes[id].op)) pairs_[program.nodes[id].a].push_back(id);
}

std::vector<Statement> Statements::of(Stage stage) const {
  std::vector<Statement> steps;
  const std::vector<Statement> batches = angle_batches(stage);
  std::vector<bool> taken = inside_angles(batches);
  const auto take = [&](NodeId id) {
    if (taken[id] || is_leaf(program_.nodes[id].op) || program_.stages[id] != stage) return;
    taken[id] = true;
    if (!is_trigonometric(program_.nodes[id].op)) steps.push_back({id, {}});  // those with their batch
  };
  for (const Statement& batch : batches) {
    for (NodeId angle : batch.batch)
      for (NodeId id : with_operands(angle, stage, taken)) take(id);
    steps.push_back(batch);
  }
  for (NodeId id = 0; id < program_.nodes.size(); ++id) take(id);
  return steps;
}

std::vector<NodeId> Statements::takes(const Statement& step) const {
  if (!step.angles.empty()) return {};
  if (!step.batch.empty()) return step.batch;
  const Operands operands(program_.nodes[step.node]);
  return {operands.begin(), operands.end()};
}

std::vector<NodeId> Statements::gives(const Statement& step) const {
  if (step.batch.empty()) return {step.node};
  std::vector<NodeId> pairs;
  for (NodeId angle : step.batch) pairs.insert(pairs.end(), pairs_[angle].begin(), pairs_[angle].end());
  return pairs;
}

// Of one angle the processor gains nothing.
std::vector<AffineAngle> Statements::written_together(const std::vector<NodeId>& batch) const {
  std::vector<AffineAngle> angles;
  for (NodeId angle : batch)
    if (auto written = written_angle(program_, angle)) angles.push_back(std::move(*written));
  if (batch.size() < 2 || angles.size() < batch.size()) return {};
  return angles;
}

// What nothing but angles of such batches takes: it is part of them.
std::vector<bool> Statements::inside_angles(const std::vector<Statement>& batches) const {
  std::vector<int> uses(program_.nodes.size(), 0);
  for (NodeId output : program_.outputs) ++uses[output];
  for (const ExpressionNode& n : program_.nodes)
    if (!is_trigonometric(n.op))
      for (NodeId x : Operands(n)) ++uses[x];
  std::vector<bool> inside(program_.nodes.size(), false);
  for (const Statement& batch : batches) {
    if (batch.angles.empty()) continue;
    for (NodeId id : batch.batch)
      for (; program_.nodes[id].op == Op::fma && uses[id] == 0; id = program_.nodes[id].c) {
        inside[id] = true;
        --uses[program_.nodes[id].c];
      }
  }
  return inside;
}

// Angles whose sines and cosines can be had together: none of a batch's angles needs another's sine.
std::vector<Statement> Statements::angle_batches(Stage stage) const {
  constexpr std::size_t kTogether = 4;
  std::vector<int> depth(program_.nodes.size(), 0);
  std::vector<std::vector<NodeId>> levels;
  for (NodeId id = 0; id < program_.nodes.size(); ++id) {
    const ExpressionNode& n = program_.nodes[id];
    if (is_leaf(program_.nodes[id].op) || program_.stages[id] != stage) continue;
    for (NodeId x : Operands(n)) depth[id] = std::max(depth[id], depth[x]);
    depth[id] += is_trigonometric(n.op);
    if (!is_trigonometric(n.op)) continue;
    levels.resize(std::max(levels.size(), static_cast<std::size_t>(depth[id])));
    auto& level = levels[static_cast<std::size_t>(depth[id]) - 1];
    if (std::find(level.begin(), level.end(), n.a) == level.end()) level.push_back(n.a);
  }
  std::vector<Statement> batches;
  for (const auto& level : levels)
    for (std::size_t from = 0; from < level.size(); from += kTogether) {
      const std::vector<NodeId> batch(
          level.begin() + static_cast<std::ptrdiff_t>(from),
          level.begin() + static_cast<std::ptrdiff_t>(std::min(level.size(), from + kTogether)));
      batches.push_back({0, batch, written_together(batch)});
    }
  return batches;
}

// What a node takes that isn't taken yet, operands first, without recursion.
std::vector<NodeId> Statements::with_operands(NodeId root, Stage stage,
                                              const std::vector<bool>& taken) const {
  std::vector<NodeId> waiting{root}, wanted;
  std::vector<bool> seen(root + 1, false);
  while (!waiting.empty()) {
    const NodeId id = waiting.back();
    waiting.pop_back();
    if (seen[id] || is_leaf(program_.nodes[id].op) || program_.stages[id] != stage || taken[id]) continue;
    seen[id] = true;
    wanted.push_back(id);
    for (NodeId x : Operands(program_.nodes[id])) waiting.push_back(x);
  }
  std::sort(wanted.begin(), wanted.end());
  return wanted;
}

}  // namespace mixloop
