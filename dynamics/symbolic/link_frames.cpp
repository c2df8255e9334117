// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/link_frames.hpp"

#include "dynamics/procedure/bodies.hpp"
#include "dynamics/procedure/constraints.hpp"

namespace mixloop {

using E = Expression;
using V3 = Expression3;
using M3 = Expression33;

M3 parallel_axis(const V3& r, const V3& moment) {
  M3 T;
  const E trace = r.dot(moment);
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < 3; ++j) T(i, j) = (i == j ? trace : E(0.0)) - r[i] * moment[j];
  return T;
}

LinkFrames::LinkFrames(const std::shared_ptr<const Scene>& scene)
    : in_(*scene),
      model_(make_model<E>(scene, std::span<const E>(in_.parameters))),
      workspace_(model_),
      chains_(std::make_shared<ClosedChains>(in_)) {
  workspace_.solve = [chains = chains_](const auto& model, auto, const auto&, auto& ws) {
    chains->solve(model, ws);
  };
  mixloop::coordinates<E>(model_, span_of(in_.psi), in_.t, workspace_);
  coordinate_rates<E>(model_, span_of(in_.psi), span_of(in_.psid), in_.t, workspace_);
  place_links();
  lump_bodies();
}

void LinkFrames::place_links() {
  for (const auto& link : model_.links) {
    Link placed;
    placed.alpha = {link.cos_alpha, link.sin_alpha};
    placed.theta = {link.cos_theta, link.sin_theta};
    placed.moves = link.coordinate >= 0;
    E s = link.s;
    if (placed.moves && link.prismatic) s += link.scale * workspace_.q[link.coordinate];
    if (placed.moves && !link.prismatic) {
      const E angle = link.scale * workspace_.q[link.coordinate] + link.theta;
      placed.theta = {cos(angle), sin(angle)};
    }
    placed.way = {link.a, E(0.0), s};
    links_.push_back(placed);
  }
}

// What a frame's inertia is to its parent: in the axes of mid, about the parent's origin.
Inertia LinkFrames::in_mid(std::size_t i, const Inertia& own) const {
  const Link& link = links_[i];
  Inertia mid;
  mid.mass = own.mass;
  const V3 moment = link.alpha.back_x(own.moment);
  mid.moment = moment + link.way * own.mass;
  const M3 cross_term = parallel_axis(link.way, moment);
  mid.tensor = link.alpha.back_x(own.tensor) + cross_term + cross_term.transpose() +
               parallel_axis(link.way, V3(link.way * own.mass));
  return mid;
}

Inertia LinkFrames::in_parent(std::size_t i, const Inertia& mid) const {
  const Turn& theta = links_[i].theta;
  return {mid.mass, theta.back_z(mid.moment), theta.back_z(mid.tensor)};
}

// One inertia a frame; what hangs on a fixed transform goes to the frame that carries it.
void LinkFrames::lump_bodies() {
  inertias_.resize(links_.size() + 1);
  for (const auto& body : model_.bodies) {
    Inertia own;
    own.mass = body.mass;
    own.moment = body.center_of_mass * body.mass;
    own.tensor = body.inertia + parallel_axis(body.center_of_mass, own.moment);
    inertias_[static_cast<std::size_t>(body.frame)] += own;
  }
  for (std::size_t i = links_.size(); i-- > 0;) {
    if (links_[i].moves) continue;
    inertias_[parent(i)] += in_parent(i, in_mid(i, inertias_[i + 1]));
    inertias_[i + 1] = Inertia();
  }
}

// A wrench on a frame, at the parent's origin in mid.
Wrench LinkFrames::in_mid(std::size_t i, const Wrench& own) const {
  const V3 force = links_[i].alpha.back_x(own.force);
  return {force, links_[i].alpha.back_x(own.moment) + cross(links_[i].way, force)};
}

Wrench LinkFrames::in_parent(std::size_t i, const Wrench& mid) const {
  return {links_[i].theta.back_z(mid.force), links_[i].theta.back_z(mid.moment)};
}

// A vector in inertial axes, in a frame's.
V3 LinkFrames::in_frame(int frame, V3 x) const {
  std::vector<std::size_t> way;
  for (; frame > 0; frame = model_.links[way.back()].parent)
    way.push_back(static_cast<std::size_t>(frame - 1));
  for (; !way.empty(); way.pop_back())
    x = links_[way.back()].alpha.into_x(links_[way.back()].theta.into_z(x));
  return x;
}

LineState<E> LinkFrames::line_state() const {
  return {span_of(in_.psi), span_of(in_.psid), workspace_.q, workspace_.qd, in_.t};
}

void LinkFrames::add_spring_dampers(ExpressionVector& on_q, ExpressionVector& on_psi) const {
  add_coordinate_loads<E>(model_, workspace_.q, workspace_.qd, on_q);
  std::vector<LineStep<E>> line(links_.size());
  add_line_loads<E>(model_, line_state(), line, on_q, on_psi);
}

E LinkFrames::spring_potentials() const {
  std::vector<LineStep<E>> line(links_.size());
  return spring_potential<E>(model_, workspace_.q) + line_potential<E>(model_, line_state(), line);
}

void LinkFrames::subtract_loads(std::vector<Wrench>& wrench) const {
  const auto timed = [&](int symbol) {
    return symbol == Symbols::kTime
               ? in_.t
               : model_.parameters[static_cast<std::size_t>(symbol - Symbols::kParameter0)];
  };
  for (std::size_t l = 0; l < model_.loads.size(); ++l) {
    const auto& said = model_.scene->loads[l];
    V3 force, moment;
    for (std::size_t i = 0; i < 3; ++i) {
      force[static_cast<Eigen::Index>(i)] = evaluate<E>(said.force[i], timed);
      moment[static_cast<Eigen::Index>(i)] = evaluate<E>(said.moment[i], timed);
    }
    const V3 local = in_frame(said.frame, force);
    auto& at = wrench[static_cast<std::size_t>(said.frame)];
    at.force -= local;
    at.moment -= moment + cross(model_.loads[l].point, local);
  }
}

}  // namespace mixloop
