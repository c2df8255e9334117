// SPDX-License-Identifier: MIT
// Sines and cosines of affine sums: which pairs are computed, and which follow from others.
#include <algorithm>
#include <cmath>
#include <map>

#include "dynamics/symbolic/graph.hpp"
#include "notation/functions/sincos.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kMostTerms = 24;     // longer sums are taken as one angle
constexpr std::size_t kMostSearched = 96;  // pairs are searched among so many angles

// Coefficients of one angle that come by two routes (q3 + (q2 - q3), q2) differ by roundings.
// A relative 1e-15 of a coefficient is a relative 1e-15 of its share of the angle: its own rounding.
bool same(double x, double y) { return std::fabs(x - y) <= 1e-15 * std::max(std::fabs(x), std::fabs(y)); }

bool same_terms(const AffineSum& x, const AffineSum& y, double sign) {
  return std::equal(
      x.terms.begin(), x.terms.end(), y.terms.begin(), y.terms.end(),
      [&](const auto& s, const auto& t) { return s.first == t.first && same(s.second, sign * t.second); });
}

AffineSum combined(const AffineSum& x, double p, const AffineSum& y, double q) {
  std::map<NodeId, std::pair<double, double>> terms;  // sum, and the scale its rounding is seen against
  for (const auto& [id, c] : x.terms) terms[id] = {p * c, std::fabs(p * c)};
  for (const auto& [id, c] : y.terms) {
    auto& [sum, scale] = terms[id];
    sum += q * c;
    scale = std::max(scale, std::fabs(q * c));
  }
  AffineSum result{p * x.constant + q * y.constant, {}};
  for (const auto& [id, term] : terms)
    if (std::fabs(term.first) > 1e-15 * term.second) result.terms.emplace_back(id, term.first);
  return result;
}

}  // namespace

// A sum may be as long as a scene makes it: its parts first, without recursion.
const AffineSum& Graph::affine(NodeId id) {
  if (auto known = affine_.find(id); known != affine_.end()) return known->second;
  for (std::vector<NodeId> waiting{id}; !waiting.empty();) {
    const NodeId at = waiting.back();
    const std::size_t before = waiting.size();
    if (const ExpressionNode& n = nodes_[at]; is_affine(n)) {
      for (NodeId x : Operands(n))
        if (!affine_.contains(x)) waiting.push_back(x);
    }
    if (waiting.size() > before) continue;
    waiting.pop_back();
    affine_.try_emplace(at, affine_of_known_parts(at));
  }
  return affine_.at(id);
}

bool Graph::is_affine(const ExpressionNode& n) const {
  return n.op == Op::neg || n.op == Op::add || n.op == Op::sub ||
         (n.op == Op::mul && (number(n.a) || number(n.b)));
}

AffineSum Graph::affine_of_known_parts(NodeId id) const {
  const ExpressionNode& n = nodes_[id];
  if (n.op == Op::constant) return {n.value, {}};
  AffineSum sum{0.0, {{id, 1.0}}};
  if (!is_affine(n)) return sum;
  const AffineSum& x = affine_.at(n.a);
  const AffineSum& y = n.op == Op::neg ? x : affine_.at(n.b);
  if (n.op == Op::neg)
    sum = combined(x, -1.0, {}, 0.0);
  else if (n.op == Op::mul)
    sum = number(n.a) ? combined(y, *number(n.a), {}, 0.0) : combined(x, *number(n.b), {}, 0.0);
  else
    sum = combined(x, 1.0, y, n.op == Op::add ? 1.0 : -1.0);
  if (sum.terms.size() > kMostTerms) sum = {0.0, {{id, 1.0}}};
  return sum;
}

// The pair of u + by from the pair of u.
std::pair<NodeId, NodeId> Graph::rotated(NodeId sine, NodeId cosine, double by) {
  auto cleaned = [](double x) {  // a quarter turn's cosine is 6e-17 only because pi/2 is rounded
    return std::fabs(x) < 2e-16 ? 0.0 : std::fabs(std::fabs(x) - 1.0) < 2e-16 ? std::copysign(1.0, x) : x;
  };
  const NodeId s = constant(cleaned(mixloop_functions::sin(by))),
               c = constant(cleaned(mixloop_functions::cos(by)));
  return {binary(Op::add, binary(Op::mul, sine, c), binary(Op::mul, cosine, s)),
          binary(Op::sub, binary(Op::mul, cosine, c), binary(Op::mul, sine, s))};
}

// The pair of an angle that differs by a constant from a known one, or from the sum or difference of two.
std::optional<std::pair<NodeId, NodeId>> Graph::from_known(const AffineSum& sum) {
  for (std::size_t i = 0; i < angles_.size(); ++i) {
    for (double sign : {1.0, -1.0}) {
      const Angle known = angles_[i];
      if (!same_terms(sum, known.sum, sign)) continue;
      ++angles_seen_.offset;
      const NodeId s = sign > 0 ? known.sine : unary(Op::neg, known.sine);
      return rotated(s, known.cosine, sum.constant - sign * known.sum.constant);
    }
  }
  if (angles_.size() > kMostSearched) return std::nullopt;
  for (std::size_t i = 0; i < angles_.size(); ++i) {
    for (std::size_t j = i; j < angles_.size(); ++j) {
      for (auto [p, q] : {std::pair{1.0, 1.0}, {1.0, -1.0}, {-1.0, 1.0}, {-1.0, -1.0}}) {
        const Angle u = angles_[i], v = angles_[j];
        if (i == j && p != q) continue;
        const AffineSum both = combined(u.sum, p, v.sum, q);
        if (!same_terms(sum, both, 1.0)) continue;
        ++angles_seen_.combined;
        const NodeId su = p > 0 ? u.sine : unary(Op::neg, u.sine),
                     sv = q > 0 ? v.sine : unary(Op::neg, v.sine);
        const NodeId s = binary(Op::add, binary(Op::mul, su, v.cosine), binary(Op::mul, u.cosine, sv));
        const NodeId c = binary(Op::sub, binary(Op::mul, u.cosine, v.cosine), binary(Op::mul, su, sv));
        return rotated(s, c, sum.constant - both.constant);
      }
    }
  }
  return std::nullopt;
}

NodeId Graph::held(NodeId of, unsigned tag) {
  if (number(of)) return of;
  return intern({Op::hold, of, tag});
}

void Graph::set_pair(NodeId angle, NodeId cosine, NodeId sine) {
  if (!pairs_.emplace(angle, std::pair{sine, cosine}).second) return;
  angles_.push_back({affine(angle), sine, cosine});
  partners_[sine] = cosine;
  partners_[cosine] = sine;
}

void Graph::forget_pairs_through(std::span<const NodeId> places) {
  std::vector<bool> through(nodes_.size(), false);
  for (const NodeId place : places) through[place] = true;
  for (NodeId id = 0; id < nodes_.size(); ++id) {
    for (NodeId x : Operands(nodes_[id]))
      if (through[x]) through[id] = true;
  }
  const auto is_through = [&](NodeId sine, NodeId cosine) { return through[sine] || through[cosine]; };
  std::erase_if(angles_, [&](const Angle& angle) { return is_through(angle.sine, angle.cosine); });
  std::erase_if(pairs_,
                [&](const auto& known) { return is_through(known.second.first, known.second.second); });
}

std::pair<NodeId, NodeId> Graph::sine_cosine(NodeId angle) {
  ++angles_seen_.asked;
  if (auto known = pairs_.find(angle); known != pairs_.end()) return known->second;
  const AffineSum sum = affine(angle);
  std::pair<NodeId, NodeId> pair;
  if (sum.terms.empty()) {
    pair = rotated(zero_, one_, sum.constant);
  } else if (auto known = from_known(sum)) {
    pair = *known;
    angles_.push_back({sum, pair.first, pair.second});
  } else if (is(angle, Op::neg)) {
    pair = sine_cosine(nodes_[angle].a);
    pair.first = unary(Op::neg, pair.first);
  } else {
    ++angles_seen_.own;
    pair = {intern({Op::sin, angle}), intern({Op::cos, angle})};
    angles_.push_back({sum, pair.first, pair.second});
  }
  pairs_.emplace(angle, pair);
  return pair;
}

}  // namespace mixloop
