// SPDX-License-Identifier: MIT
#include "planner/three_axis_arm.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "dynamics/procedure/constraints.hpp"
#include "dynamics/scene/end_effector_chain.hpp"

namespace mixloop {
namespace {

using Link = Model<double>::Link;

/// The links from the ground to the end effector's frame.
std::vector<const Link*> chain_of(const Model<double>& model) {
  std::vector<const Link*> chain;
  for (int frame = model.scene->end_effector.frame; frame != 0;) {
    const Link& link = model.links[static_cast<std::size_t>(frame - 1)];
    chain.insert(chain.begin(), &link);
    frame = link.parent;
  }
  return chain;
}

/// Of each coordinate: whether it is affine in the motors, through all that it refers to, and independent of
/// time.
std::vector<bool> affine_coordinates(const Scene& scene) {
  const Symbols symbols(scene);
  std::vector<bool> affine(scene.coordinates.size(), false);
  const auto varies = [&](int symbol) {
    return symbol == Symbols::kTime || symbols.is_psi(symbol) || symbols.is_q(symbol);
  };
  const auto may_stand = [&](const Formula::Node& node) {
    if (node.op != Formula::Operator::symbol) return true;
    return node.symbol != Symbols::kTime &&
           (!symbols.is_q(node.symbol) || affine[static_cast<std::size_t>(node.symbol - symbols.q0)]);
  };
  for (const int j : scene.evaluation_order) {
    const Formula& constraint = scene.coordinates[static_cast<std::size_t>(j)].constraint;
    affine[static_cast<std::size_t>(j)] =
        degree(constraint, varies) <= 1 &&
        std::all_of(constraint.nodes.begin(), constraint.nodes.end(), may_stand);
  }
  return affine;
}

bool has_the_form(const Model<double>& model, const std::vector<const Link*>& chain) {
  const Scene& scene = *model.scene;
  if (scene.n() != 3 || scene.n_u() != 3 || scene.end_effector.axes.size() != 3 || chain.size() != 3)
    return false;
  const auto affine = affine_coordinates(scene);
  for (const Link* link : chain)
    if (link->coordinate < 0 || link->prismatic || link->scale == 0 ||
        !affine[static_cast<std::size_t>(link->coordinate)])
      return false;
  return chain[0]->cos_alpha == 0 && chain[1]->cos_alpha == 1;
}

/// The motors' share in the angles, from the constraints and the transforms.
void mixture(const Model<double>& model, const std::vector<const Link*>& chain, ThreeAxisArm& arm) {
  Workspace<double> ws(model);
  const Vector zero = Vector::Zero(3);
  coordinates<double>(model, span_of<double>(zero), 0.0, ws);
  for (int i = 0; i < 3; ++i) {
    const Link& link = *chain[static_cast<std::size_t>(i)];
    arm.B.row(i) = link.scale * ws.C.row(link.coordinate);
    arm.offset[i] = link.scale * ws.q[link.coordinate] + link.theta;
  }
}

double sign_or_one(double x) { return x < 0 ? -1 : 1; }

}  // namespace

std::optional<ThreeAxisArm> find_three_axis_arm(const Model<double>& whole) {
  const auto model =
      make_model<double>(with_shortest_chain(whole.scene), std::span<const double>(whole.parameters));
  const auto chain = chain_of(model);
  if (!has_the_form(model, chain)) return std::nullopt;
  const Link &first = *chain[0], &second = *chain[1], &third = *chain[2];
  const Vec3<double>& point = model.end_effector_point;
  ThreeAxisArm arm;
  arm.height = first.s;
  arm.side = first.sin_alpha;
  arm.base = first.a;
  // The end effector from the elbow axis, in axes that turn with frame 3: along, across and beside the plane.
  const double along = third.a + point[0];
  const double across = third.cos_alpha * point[1] - third.sin_alpha * point[2];
  arm.lateral = second.s + third.s + third.sin_alpha * point[1] + third.cos_alpha * point[2];
  arm.upper = std::abs(second.a);
  arm.fore = std::sqrt(along * along + across * across);
  if (arm.upper == 0 || arm.fore == 0) return std::nullopt;

  mixture(model, chain, arm);
  const double turned = second.a < 0 ? std::numbers::pi : 0;
  arm.offset[1] += turned;
  arm.offset[2] += mixloop_functions::atan2(across, along) - turned;
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(arm.B);
  if (!lu.isInvertible()) return std::nullopt;
  arm.B_inverse = lu.inverse();

  const Eigen::Vector3d home = arm.angles(Eigen::Map<const Eigen::Vector3d>(model.scene->home.data()));
  arm.front = sign_or_one(arm.base + arm.upper * mixloop_functions::cos(home[1]) +
                          arm.fore * mixloop_functions::cos(home[1] + home[2]));
  arm.elbow = sign_or_one(mixloop_functions::sin(home[2]));
  return arm;
}

ArmReach reach_of(const ThreeAxisArm& arm, const Eigen::Vector3d& point) {
  const double beside = point.head<2>().squaredNorm() - arm.lateral * arm.lateral;
  const double X = arm.front * std::sqrt(std::max(beside, 0.0)) - arm.base;
  return {beside, std::sqrt(X * X + (point[2] - arm.height) * (point[2] - arm.height))};
}

}  // namespace mixloop
