// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/procedure/closure_rows.hpp"
#include "dynamics/procedure/workspace.hpp"

namespace mixloop {

namespace detail {

/// The coordinates along the line (psi + s dpsi, t + s dt), into ws.along; where closures are solved, from
/// ws.x and ws.systems.
template <class T>
class CoordinatesAlong {
 public:
  /// psi is n long; dpsi too, or null.
  CoordinatesAlong(const Model<T>& model, std::span<const T> psi, const T* dpsi, const T& t, const T& dt,
                   Workspace<T>& ws)
      : model_(model), symbols_(*model.scene), psi_(psi), dpsi_(dpsi), t_(t), dt_(dt), ws_(ws) {}

  /// All of them, a block's as the implicit function theorem gives them; with second derivatives, or without.
  void work_out(bool twice) {
    for (const auto& step : model_.scene->steps) {
      if (step.coordinate >= 0)
        by_formula(step.coordinate);
      else
        by_closures(step.block, twice);
    }
  }

  void by_formula(int j) {
    along(j) = evaluate<Taylor<T>>(model_.scene->coordinates[static_cast<std::size_t>(j)].constraint, *this);
  }

  /// A block's rows where its unknowns are as `along` has them.
  std::vector<Taylor<T>> rows_of(const Scene::Block& block) {
    for (int j : block.within) by_formula(j);
    return rows_of(block.rows);
  }
  std::vector<Taylor<T>> rows_of(const std::vector<Scene::ClosureRow>& which) const {
    const auto coordinate = [&](int j) -> const Taylor<T>& { return ws_.along[static_cast<std::size_t>(j)]; };
    const ClosureRows<T, decltype(coordinate), CoordinatesAlong> rows(model_, coordinate, *this);
    std::vector<Taylor<T>> result, whole;
    int last = -1;
    for (const auto& row : which) {
      if (row.closure != last) whole = rows.of(row.closure);
      last = row.closure;
      result.push_back(whole[static_cast<std::size_t>(row.row)]);
    }
    return result;
  }

  /// The rows' values and their slopes by the block's unknowns, where these are as in ws.x.
  void linearise(const Scene::Block& block, Mat<T>& slopes, Vec<T>& values) {
    const auto k = static_cast<Eigen::Index>(block.unknowns.size());
    slopes.resize(k, k);
    values.resize(k);
    for (Eigen::Index c = 0; c < k; ++c) {
      for (Eigen::Index i = 0; i < k; ++i) {
        const int j = block.unknowns[static_cast<std::size_t>(i)];
        along(j) = Taylor<T>(ws_.x[j], T(i == c ? 1 : 0), T(0));
      }
      const auto rows = rows_of(block);
      for (Eigen::Index i = 0; i < k; ++i) {
        slopes(i, c) = rows[static_cast<std::size_t>(i)].d;
        values[i] = rows[static_cast<std::size_t>(i)].v;
      }
    }
  }

  /// The block's coordinates, and what has a formula of them, stand still where ws.x has them.
  void settle(const Scene::Block& block) {
    for (int j : block.unknowns) along(j) = Taylor<T>(ws_.x[j], T(0), T(0));
    for (int j : block.within) by_formula(j);
  }

  T& x(int j) { return ws_.x[j]; }
  Taylor<T>& along(int j) { return ws_.along[static_cast<std::size_t>(j)]; }

  /// A formula's symbol.
  Taylor<T> operator()(int number) const {
    if (symbols_.is_q(number)) return ws_.along[static_cast<std::size_t>(number - symbols_.q0)];
    if (symbols_.is_psi(number)) {
      const auto i = static_cast<std::size_t>(number - symbols_.psi0);
      return {psi_[i], dpsi_ ? dpsi_[i] : T(0), T(0)};
    }
    if (number == Symbols::kTime) return {t_, dt_, T(0)};
    return Taylor<T>(model_.parameters[static_cast<std::size_t>(number - Symbols::kParameter0)]);
  }

 private:
  // G(x, psi, t) = 0 along the line: G_x x' = -(G' at fixed x), and G_x x'' = -(G'' with that x', x'' none).
  void by_closures(int b, bool twice) {
    const Scene::Block& block = model_.scene->blocks[static_cast<std::size_t>(b)];
    for (int j : block.unknowns) along(j) = Taylor<T>(ws_.x[j], T(0), T(0));
    const Vec<T> first = solved(b, [](const Taylor<T>& row) { return row.d; });
    for (Eigen::Index i = 0; i < first.size(); ++i)
      along(block.unknowns[static_cast<std::size_t>(i)]).d = first[i];
    if (twice) {
      const Vec<T> second = solved(b, [](const Taylor<T>& row) { return row.dd; });
      for (Eigen::Index i = 0; i < second.size(); ++i)
        along(block.unknowns[static_cast<std::size_t>(i)]).dd = second[i];
    }
    for (int j : block.within) by_formula(j);
  }

  template <class Part>
  Vec<T> solved(int b, const Part& part) {
    const auto rows = rows_of(model_.scene->blocks[static_cast<std::size_t>(b)]);
    Vec<T> right(static_cast<Eigen::Index>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) right[static_cast<Eigen::Index>(i)] = -part(rows[i]);
    return ws_.systems[static_cast<std::size_t>(b)].solve(right);
  }

  const Model<T>& model_;
  const Symbols symbols_;
  const std::span<const T> psi_;
  const T* const dpsi_;
  const T t_, dt_;
  Workspace<T>& ws_;
};

// Compiled once for double, in procedure.cpp.
extern template class CoordinatesAlong<double>;

}  // namespace detail

}  // namespace mixloop
