// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "dynamics/procedure/kinematics.hpp"

/// Springs and dampers along a quantity f: along a formula of coordinates, or along the distance of two
/// points. What the motion takes there, k (f - rest) + d f', is shared out by f's exact partial derivatives
/// (virtual work).
namespace mixloop {

/// Where the mechanism is and how it moves, for loads along lines.
template <class T>
struct LineState {
  std::span<const T> psi, psid;  ///< n
  const Vec<T>&q, &qd;           ///< m
  const T& t;
};

namespace detail {

template <class T>
T value_at(const Model<T>& model, const LineState<T>& at, int symbol) {
  const Symbols symbols(*model.scene);
  if (symbols.is_q(symbol)) return at.q[symbol - symbols.q0];
  if (symbols.is_psi(symbol)) return at.psi[static_cast<std::size_t>(symbol - symbols.psi0)];
  if (symbol == Symbols::kTime) return at.t;
  return model.parameters[static_cast<std::size_t>(symbol - Symbols::kParameter0)];
}

template <class T>
T along_value(const Model<T>& model, std::size_t load, const LineState<T>& at) {
  return evaluate<T>(model.scene->along_loads[load].along,
                     [&](int symbol) { return value_at(model, at, symbol); });
}

/// d f / d symbol, all other symbols held.
template <class T>
T along_partial(const Model<T>& model, std::size_t load, const LineState<T>& at, int symbol) {
  return evaluate<Taylor<T>>(model.scene->along_loads[load].along,
                             [&](int other) -> Taylor<T> {
                               return {value_at(model, at, other), T(other == symbol ? 1 : 0), T(0)};
                             })
      .d;
}

template <class T>
T rate_of(const Model<T>& model, const LineState<T>& at, int symbol) {
  const Symbols symbols(*model.scene);
  if (symbols.is_q(symbol)) return at.qd[symbol - symbols.q0];
  if (symbols.is_psi(symbol)) return at.psid[static_cast<std::size_t>(symbol - symbols.psi0)];
  return T(1);  // of the time
}

/// A point, and how it moves, in the axes of the frame where the chains of a load's two ends part.
template <class T>
struct MovingPoint {
  Vec3<T> at, rate;
};

/// From an end's own frame down its chain; leaves in `line` what the way back up needs.
template <class T>
MovingPoint<T> carried_down(const Model<T>& model, const std::vector<int>& chain, const Vec3<T>& point,
                            const LineState<T>& state, std::vector<LineStep<T>>& line) {
  MovingPoint<T> moving{point, Vec3<T>(T(0), T(0), T(0))};
  for (const int i : chain) {
    const auto& link = model.links[static_cast<std::size_t>(i)];
    const T &ca = link.cos_alpha, &sa = link.sin_alpha;
    const Varying<T> now = varying<T>(link, state.q);
    const auto turned_back = [&](const Vec3<T>& x) {
      return Vec3<T>(x[0], ca * x[1] - sa * x[2], sa * x[1] + ca * x[2]);
    };
    const auto in_parent = [&](const Vec3<T>& x) {
      return Vec3<T>(now.cosine * x[0] - now.sine * x[1], now.sine * x[0] + now.cosine * x[1], x[2]);
    };
    // in two steps: into axes that have turned about z, where the way to the frame is (a, 0, s), then
    // into the parent's.
    const Vec3<T> arm = turned_back(moving.at) + Vec3<T>(link.a, T(0), now.s);
    Vec3<T> rate = turned_back(moving.rate);
    if (link.coordinate >= 0) {
      const T speed = link.scale * state.qd[link.coordinate];
      rate += link.prismatic ? Vec3<T>(T(0), T(0), speed) : Vec3<T>(-(speed * arm[1]), speed * arm[0], T(0));
    }
    line[static_cast<std::size_t>(i)] = {arm, now.cosine, now.sine};
    moving = {in_parent(arm), in_parent(rate)};
  }
  return moving;
}

/// A force on an end, in the axes where the chains part, as its share of each coordinate of its chain.
template <class T, class Out>
void share_out(const Model<T>& model, const std::vector<int>& chain, Vec3<T> force,
               const std::vector<LineStep<T>>& line, Out& a) {
  for (std::size_t k = chain.size(); k-- > 0;) {
    const auto i = static_cast<std::size_t>(chain[k]);
    const auto& link = model.links[i];
    const LineStep<T>& step = line[i];
    const T x = step.cosine * force[0] + step.sine * force[1];
    const T y = step.cosine * force[1] - step.sine * force[0];
    const T z = force[2];
    if (link.coordinate >= 0)
      a[link.coordinate] += link.scale * (link.prismatic ? z : step.arm[0] * y - step.arm[1] * x);
    force = {x, link.cos_alpha * y + link.sin_alpha * z, link.cos_alpha * z - link.sin_alpha * y};
  }
}

/// What the motion takes for each metre that the points are apart: k - k rest / |r| + d (r . r') / |r|^2. Not
/// finite where it needs a direction and there is none.
template <class T>
T taken_a_metre(const typename Model<T>::BetweenLoad& load, const Vec3<T>& r, const Vec3<T>& rate) {
  using std::sqrt;
  T sum = load.law.stiffness;
  if (!load.stretches && !load.damps) return sum;
  const T square = r.dot(r);
  if (load.stretches) sum -= load.law.stiffness * load.law.rest / sqrt(square);
  if (load.damps) sum += load.law.damping * (r.dot(rate) / square);
  return sum;
}

/// From the first end to the second.
template <class T>
MovingPoint<T> between(const Model<T>& model, const typename Model<T>::BetweenLoad& load,
                       const LineState<T>& at, std::vector<LineStep<T>>& line) {
  const auto [one, one_rate] = carried_down(model, load.chain[0], load.point[0], at, line);
  const auto [other, other_rate] = carried_down(model, load.chain[1], load.point[1], at, line);
  return {other - one, other_rate - one_rate};
}

}  // namespace detail

/// Adds what the motion takes along formulas: along the coordinates (m) and, where a formula names them,
/// along the independent ones directly (n).
template <class T, class OnQ, class OnPsi>
void add_along_loads(const Model<T>& model, const LineState<T>& at, OnQ& on_q, OnPsi& on_psi) {
  const Symbols symbols(*model.scene);
  for (std::size_t i = 0; i < model.along_loads.size(); ++i) {
    const auto& [law, names] = model.along_loads[i];
    T rate(0);
    for (const int symbol : names)
      rate += detail::along_partial(model, i, at, symbol) * detail::rate_of(model, at, symbol);
    const T taken = law.stiffness * (detail::along_value(model, i, at) - law.rest) + law.damping * rate;
    for (const int symbol : names) {
      const T share = detail::along_partial(model, i, at, symbol) * taken;
      if (symbols.is_q(symbol)) on_q[symbol - symbols.q0] += share;
      if (symbols.is_psi(symbol)) on_psi[symbol - symbols.psi0] += share;
    }
  }
}

/// The same, and between points. `line` has a place for each link where there is a load between points.
template <class T, class OnQ, class OnPsi>
void add_line_loads(const Model<T>& model, const LineState<T>& at, std::vector<LineStep<T>>& line, OnQ& on_q,
                    OnPsi& on_psi) {
  add_along_loads(model, at, on_q, on_psi);
  for (const auto& load : model.between_loads) {
    const auto [r, rate] = detail::between(model, load, at, line);
    const Vec3<T> force = r * detail::taken_a_metre<T>(load, r, rate);
    detail::share_out(model, load.chain[0], Vec3<T>(-force), line, on_q);
    detail::share_out(model, load.chain[1], force, line, on_q);
  }
}

/// What these springs hold: sum k/2 (f - rest)^2.
template <class T>
T line_potential(const Model<T>& model, const LineState<T>& at, std::vector<LineStep<T>>& line) {
  using std::sqrt;
  T sum(0);
  for (std::size_t i = 0; i < model.along_loads.size(); ++i) {
    const auto& law = model.along_loads[i].law;
    const T stretch = detail::along_value(model, i, at) - law.rest;
    sum += law.stiffness * stretch * stretch / T(2);
  }
  for (const auto& load : model.between_loads) {
    const Vec3<T> r = detail::between(model, load, at, line).at;
    const T square = r.dot(r);
    const T stretch = load.stretches ? T(sqrt(square) - load.law.rest) : T(0);
    sum += load.law.stiffness * (load.stretches ? T(stretch * stretch) : square) / T(2);
  }
  return sum;
}

}  // namespace mixloop
