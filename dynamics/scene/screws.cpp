// SPDX-License-Identifier: MIT
#include "dynamics/scene/screws.hpp"

#include <algorithm>

namespace mixloop {

Formula sum_of(const Formula& left, const Formula& right) {
  if (left.is_zero()) return right;
  if (right.is_zero()) return left;
  if (left.is_constant() && right.is_constant())
    return constant_formula(left.constant() + right.constant(), left.dimension, left.place);
  Formula sum = left;
  const int shift = static_cast<int>(left.nodes.size());
  for (Formula::Node node : right.nodes) {
    if (node.left >= 0) node.left += shift;
    if (node.right >= 0) node.right += shift;
    sum.nodes.push_back(node);
  }
  sum.nodes.push_back(
      {.op = Formula::Operator::add, .left = shift - 1, .right = static_cast<int>(sum.nodes.size()) - 1});
  sum.height = std::max(left.height, right.height) + 1;
  if (!right.is_constant()) sum.place = right.place;  // where a joint's value stands, behind its pose's
  return sum;
}

Formula opposite_of(const Formula& formula) {
  if (formula.is_constant()) return constant_formula(-formula.constant(), formula.dimension, formula.place);
  Formula opposite = formula;
  opposite.nodes.push_back(
      {.op = Formula::Operator::negate, .left = static_cast<int>(formula.nodes.size()) - 1});
  ++opposite.height;
  return opposite;
}

// Screws about one axis commute.
void Screws::add(bool about_z, const Formula& angle, const Formula& shift) {
  if (screws_.empty() || screws_.back().about_z != about_z)
    screws_.push_back({about_z, zero(kPure), zero(kLength)});
  Screw& last = screws_.back();
  last.angle = sum_of(last.angle, angle);
  last.shift = sum_of(last.shift, shift);
  if (last.angle.is_zero() && last.shift.is_zero()) screws_.pop_back();
}

std::vector<Scene::Transform> Screws::transforms() const {
  std::vector<Scene::Transform> all;
  const auto fresh = [&]() -> Scene::Transform& {
    Scene::Transform transform;
    transform.theta = transform.alpha = zero(kPure);
    transform.s = transform.a = zero(kLength);
    transform.place = place_;
    return all.emplace_back(std::move(transform));
  };
  for (std::size_t i = 0; i < screws_.size(); ++i) {
    const bool begins = screws_[i].about_z || i == 0 || !screws_[i - 1].about_z;
    Scene::Transform& transform = begins ? fresh() : all.back();
    (screws_[i].about_z ? transform.theta : transform.alpha) = screws_[i].angle;
    (screws_[i].about_z ? transform.s : transform.a) = screws_[i].shift;
  }
  if (all.empty()) fresh();
  return all;
}

}  // namespace mixloop
