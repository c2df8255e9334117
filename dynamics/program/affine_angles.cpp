// SPDX-License-Identifier: MIT
#include "dynamics/program/affine_angles.hpp"

#include <algorithm>

namespace mixloop {
namespace {

constexpr std::size_t kMostTerms = 4;
constexpr int kDeepest = 32;  // operations, one in another

bool is_plain(const AffineAngle& angle) {
  return angle.constant == 0 && angle.terms.size() == 1 && angle.terms[0].second == 1;
}

}  // namespace

void AffineAngles::Sum::add(const Sum& other, const DoubleDouble& factor) {
  constant += factor * other.constant;
  for (const auto& [index, x] : other.terms) terms[index] += factor * x;
  height = std::max(height, other.height);
}

AffineAngles::AffineAngles(const Program& program) {
  for (NodeId id = 0; id < program.nodes.size(); ++id)
    if (auto sum = sum_of(program.nodes[id])) sums_.emplace(id, std::move(*sum));
}

// Of nodes that are known already.
std::optional<AffineAngles::Sum> AffineAngles::sum_of(const ExpressionNode& n) const {
  if (n.op == Op::constant) return Sum{n.value, {}};
  if (n.op == Op::input && static_cast<Block>(n.a) == Block::psi) return Sum{0, {{n.b, 1}}};
  if (n.op != Op::neg && n.op != Op::add && n.op != Op::sub && n.op != Op::mul) return std::nullopt;
  for (NodeId x : Operands(n))
    if (!sums_.contains(x)) return std::nullopt;
  static const Sum none;
  const Sum *a = &sums_.at(n.a), *b = n.op == Op::neg ? &none : &sums_.at(n.b);
  if (std::max(a->height, b->height) == kDeepest || a->terms.size() + b->terms.size() > 2 * kMostTerms)
    return std::nullopt;
  Sum sum;
  if (n.op == Op::mul) {
    if (!a->terms.empty()) std::swap(a, b);
    if (!a->terms.empty()) return std::nullopt;
    sum.add(*b, a->constant);
    sum.height = std::max(sum.height, a->height);
  } else {
    sum.add(*a, n.op == Op::neg ? -1 : 1);
    sum.add(*b, n.op == Op::sub ? -1 : 1);
  }
  ++sum.height;
  return sum;
}

std::optional<AffineAngle> AffineAngles::at(NodeId angle) const {
  const auto sum = sums_.find(angle);
  if (sum == sums_.end()) return std::nullopt;
  AffineAngle result{static_cast<double>(sum->second.constant), {}};
  for (const auto& [index, factor] : sum->second.terms)
    if (factor != 0) result.terms.emplace_back(index, static_cast<double>(factor));
  if (result.terms.empty() || result.terms.size() > kMostTerms || is_plain(result)) return std::nullopt;
  return result;
}

std::optional<AffineAngle> written_angle(const Program& program, NodeId angle) {
  AffineAngle result;
  const ExpressionNode* n = &program.nodes[angle];
  for (; n->op == Op::fma; n = &program.nodes[n->c]) {
    const ExpressionNode *psi = &program.nodes[n->a], *factor = &program.nodes[n->b];
    if (psi->op != Op::input) std::swap(psi, factor);
    if (psi->op != Op::input || static_cast<Block>(psi->a) != Block::psi || factor->op != Op::constant)
      return std::nullopt;
    result.terms.emplace_back(psi->b, factor->value);
  }
  if (n->op != Op::constant || result.terms.empty() || result.terms.size() > kMostTerms) return std::nullopt;
  result.constant = n->value;
  std::reverse(result.terms.begin(), result.terms.end());
  return std::is_sorted(result.terms.begin(), result.terms.end()) ? std::optional(result) : std::nullopt;
}

}  // namespace mixloop
