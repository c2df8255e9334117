// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <stdexcept>
#include <utility>

#include "dynamics/procedure/coordinates_along.hpp"

namespace mixloop {

namespace detail {

/// Newton's method on numbers, from the solution that is known nearest.
template <class T>
class ClosureSearch {
 public:
  ClosureSearch(const Model<T>& model, Workspace<T>& ws)
      : model_(model), scene_(*model.scene), ws_(ws), psi_(model.n()) {}

  /// Solves where the motors are at `psi` at time t: at once, or along the straight line from the last
  /// solution. False, x not finite, where a singular pose or the end of the mechanism's reach is on it.
  bool reach(std::span<const T> psi, const T& t) {
    const Vec<T> from = ws_.anchor_psi, from_x = ws_.anchor_x, to = map_of(psi);
    const T from_t = ws_.anchor_t;
    T at(0), step(1);
    while (at < T(1)) {
      const T next = at + step < T(1) ? T(at + step) : T(1);
      psi_ = next < T(1) ? Vec<T>(from + (to - from) * next) : to;
      const T now = next < T(1) ? T(from_t + (t - from_t) * next) : t;
      if (solve(now)) {
        at = next;
        step *= T(2);
        ws_.anchor_x = ws_.x, ws_.anchor_psi = psi_, ws_.anchor_t = now;
      } else if (step > T(kLeastStep)) {
        step /= T(4);
      } else {
        ws_.anchor_x = from_x, ws_.anchor_psi = from, ws_.anchor_t = from_t;
        ws_.x.setConstant(std::numeric_limits<T>::quiet_NaN());
        return false;
      }
    }
    return true;
  }

 private:
  static constexpr double kLeastStep = 1e-6;
  static constexpr double kMostAtOnce = 0.3;  ///< rad, or of the mechanism's size: what may be on one branch
  static constexpr int kMostCorrections = 20;

  bool solve(const T& t) {
    ws_.x = ws_.anchor_x;
    CoordinatesAlong<T> along(model_, span_of(std::as_const(psi_)), nullptr, t, T(0), ws_);
    for (const auto& step : scene_.steps) {
      if (step.coordinate >= 0)
        along.by_formula(step.coordinate);
      else if (!solve(static_cast<std::size_t>(step.block), along))
        return false;
    }
    return true;
  }

  bool solve(std::size_t b, CoordinatesAlong<T>& along) {
    using std::abs;
    const Scene::Block& block = scene_.blocks[b];
    Mat<T> slopes;
    Vec<T> values;
    T last = std::numeric_limits<T>::max();
    const auto settled = [&] {
      along.settle(block);
      return true;
    };
    for (int i = 0; i < kMostCorrections; ++i) {
      along.linearise(block, slopes, values);
      ws_.systems[b] = SmallSystem<T>(slopes);
      const Vec<T> correction = ws_.systems[b].solve(-values);
      T size(0), moved(0), floor(0);
      for (Eigen::Index k = 0; k < correction.size(); ++k) {
        const int j = block.unknowns[static_cast<std::size_t>(k)];
        const T unit = scale_of(j);
        ws_.x[j] += correction[k];
        size = std::max(size, T(abs(correction[k]) / unit));
        moved = std::max(moved, T(abs(ws_.x[j] - ws_.anchor_x[j]) / unit));
        floor = std::max(floor, T(abs(ws_.x[j]) / unit));
      }
      if (!(moved <= T(kMostAtOnce))) return false;
      floor = std::numeric_limits<T>::epsilon() * std::max(floor, T(1));
      if (size <= T(4) * floor) return settled();
      // No longer shrinking: at round-off of a pose that is nearly singular, or nowhere.
      if (size > last / T(2)) return size <= T(1e4) * floor && settled();
      last = size;
    }
    return false;
  }

  T scale_of(int j) const {
    const auto& formula = scene_.coordinates[static_cast<std::size_t>(j)].constraint;
    return formula.dimension.same_powers(kLength) ? T(scene_.size) : T(1);
  }

  const Model<T>& model_;
  const Scene& scene_;
  Workspace<T>& ws_;
  Vec<T> psi_;
};

/// Brings the anchor, which is home for the scene's defaults, to the model's parameters, in steps.
template <class T>
void reach_parameters(const Model<T>& model, Workspace<T>& ws) {
  const std::vector<double> defaults = model.scene->default_parameters();
  std::vector<T> between(model.parameters);
  bool same = true;
  for (std::size_t i = 0; i < defaults.size(); ++i)
    same = same && !(between[i] < T(defaults[i])) && !(between[i] > T(defaults[i]));
  const Vec<T> home = ws.anchor_psi;
  constexpr int kSteps = 16;
  for (int k = 1; k < kSteps && !same; ++k) {
    for (std::size_t i = 0; i < defaults.size(); ++i)
      between[i] = T(defaults[i]) + (model.parameters[i] - T(defaults[i])) * T(k) / T(kSteps);
    const Model<T> now = make_model<T>(model.scene, std::span<const T>(between));
    if (!ClosureSearch<T>(now, ws).reach(span_of(home), T(0))) return;
  }
}

}  // namespace detail

/// The solved coordinates at a pose, into ws.x, and their rows' slopes into ws.systems; on the branch of the
/// last pose, at first of home.
template <class T>
void solve_closures(const Model<T>& model, std::span<const T> psi, const T& t, Workspace<T>& ws) {
  if (ws.solve) return ws.solve(model, psi, t, ws);
  if constexpr (std::numeric_limits<T>::is_specialized) {
    if (!ws.is_anchored) detail::reach_parameters(model, ws);
    ws.is_anchored = true;
    ws.is_solved = detail::ClosureSearch<T>(model, ws).reach(psi, t);
  } else {
    throw std::logic_error("closures on a scalar that nothing solves them for");
  }
}

// Compiled once for double, in procedure.cpp.
extern template void solve_closures(const Model<double>&, std::span<const double>, const double&,
                                    Workspace<double>&);

}  // namespace mixloop
