// SPDX-License-Identifier: MIT
#include "dynamics/assembly/closing.hpp"

#include <algorithm>
#include <cmath>

#include "dynamics/procedure/decompositions.hpp"

namespace mixloop {
namespace {

/// The scene with nothing to solve: its coordinates without a formula are given.
std::shared_ptr<const Scene> open_scene(const Scene& scene) {
  auto open = std::make_shared<Scene>(scene);
  open->blocks.clear();
  open->steps.clear();
  for (int j : scene.evaluation_order) open->steps.push_back({.coordinate = j});
  return open;
}

}  // namespace

double size_of(const Scene& scene) {
  double size = 0;
  const auto look = [&](const Formula& formula) {
    const double value = evaluate<double>(formula, [&](int symbol) {
      const int parameter = symbol - Symbols::kParameter0;
      const bool known = parameter >= 0 && parameter < static_cast<int>(scene.parameters.size());
      return known ? scene.parameters[static_cast<std::size_t>(parameter)].value : 0.0;
    });
    if (std::isfinite(value)) size = std::max(size, std::abs(value));
  };
  for (const auto& transform : scene.transforms) look(transform.a), look(transform.s);
  for (const auto& closure : scene.closures) {
    if (closure.has_points())
      for (const auto& point : closure.vectors)
        for (const auto& part : point) look(part);
    if (closure.kind == Scene::Closure::Kind::distance) look(closure.value);
  }
  return size > 0 ? size : 1;
}

Closing::Closing(const Scene& scene, std::span<const double> parameters)
    : scene_(open_scene(scene)), model_(make_model<double>(scene_, parameters)), ws_(model_) {
  for (int j = 0; j < scene_->m(); ++j) {
    const auto& coordinate = scene_->coordinates[static_cast<std::size_t>(j)];
    if (!coordinate.is_solved()) continue;
    unknowns_.push_back(j);
    unit_.push_back(scene_->turns(j) ? 1 : scene_->size);
  }
  for (std::size_t c = 0; c < scene_->closures.size(); ++c) {
    const auto& closure = scene_->closures[c];
    for (int r = 0; r < closure.rows(); ++r) {
      rows_.push_back({static_cast<int>(c), r});
      const bool length = scene_->is_length(rows_.back());
      row_unit_.push_back(length ? scene_->size : 1);
      row_is_length_.push_back(length);
    }
  }
}

bool Closing::turns(int unknown) const { return scene_->turns(coordinate(unknown)); }

Vector Closing::home_psi() const {
  return Eigen::Map<const Vector>(scene_->home.data(), static_cast<Eigen::Index>(scene_->home.size()));
}

Vector Closing::home() const {
  Vector x(unknowns());
  for (int i = 0; i < unknowns(); ++i)
    x[i] = scene_->coordinates[static_cast<std::size_t>(coordinate(i))].home / unit_of_unknown(i);
  return x;
}

Closing::Part Closing::whole() const {
  Part part;
  for (int i = 0; i < unknowns(); ++i) part.unknowns.push_back(i);
  for (int i = 0; i < rows(); ++i) part.rows.push_back(i);
  return part;
}

Vector Closing::along(const Part& part, const Vector& x, const Vector& psi, const double* dpsi, double t,
                      int moving, double Taylor<double>::*which) {
  Along along(model_, span_of(psi), dpsi, t, 0.0, ws_);
  for (int i = 0; i < unknowns(); ++i) {
    const double unit = unit_of_unknown(i);
    along.along(coordinate(i)) = Taylor<double>(x[i] * unit, i == moving ? unit : 0.0, 0.0);
  }
  for (int j : scene_->evaluation_order) along.by_formula(j);
  std::vector<Scene::ClosureRow> rows;
  for (int i : part.rows) rows.push_back(row(i));
  const auto found = along.rows_of(rows);
  Vector result(static_cast<Eigen::Index>(found.size()));
  for (std::size_t i = 0; i < found.size(); ++i)
    result[static_cast<Eigen::Index>(i)] = found[i].*which / unit_of_row(part.rows[i]);
  return result;
}

Vector Closing::residual(const Part& part, const Vector& x, const Vector& psi, double t) {
  return along(part, x, psi, nullptr, t, -1, &Taylor<double>::v);
}

Matrix Closing::slopes(const Part& part, const Vector& x, const Vector& psi, double t) {
  Matrix result(static_cast<Eigen::Index>(part.rows.size()), static_cast<Eigen::Index>(part.unknowns.size()));
  for (std::size_t c = 0; c < part.unknowns.size(); ++c)
    result.col(static_cast<Eigen::Index>(c)) =
        along(part, x, psi, nullptr, t, part.unknowns[c], &Taylor<double>::d);
  return result;
}

Matrix Closing::slopes_by_psi(const Part& part, const Vector& x, const Vector& psi, double t) {
  const int n = scene_->n();
  Matrix result(static_cast<Eigen::Index>(part.rows.size()), n);
  for (int c = 0; c < n; ++c) {
    const Vector direction = Vector::Unit(n, c);
    result.col(c) = along(part, x, psi, direction.data(), t, -1, &Taylor<double>::d);
  }
  return result;
}

// x' = -G_x^-1 G_psi, and what has a formula of it.
Matrix Closing::rates(const Vector& x, const Vector& psi, double t) {
  const Part part = whole();
  const auto slopes = singular_values(this->slopes(part, x, psi, t));
  const Matrix by_psi = slopes_by_psi(part, x, psi, t);
  Matrix C(scene_->m(), scene_->n());
  for (int i = 0; i < scene_->n(); ++i) {
    const Vector moved = unknowns() == 0 ? Vector() : slopes.solve(-by_psi.col(i), 1e-12, 0);
    const Vector direction = Vector::Unit(scene_->n(), i);
    Along along(model_, span_of(psi), direction.data(), t, 0.0, ws_);
    for (int u = 0; u < unknowns(); ++u) {
      const double unit = unit_of_unknown(u);
      along.along(coordinate(u)) = Taylor<double>(x[u] * unit, moved[u] * unit, 0.0);
    }
    for (int j : scene_->evaluation_order) along.by_formula(j);
    for (int j = 0; j < scene_->m(); ++j) C(j, i) = along.along(j).d;
  }
  return C;
}

double Closing::value_at(const Formula& formula, const Vector& x, const Vector& psi) {
  Along along(model_, span_of(psi), nullptr, 0.0, 0.0, ws_);
  this->along({}, x, psi, nullptr, 0, -1, &Taylor<double>::v);
  return evaluate<Taylor<double>>(formula, along).v;
}

std::vector<double> Closing::coordinates(const Vector& x, const Vector& psi, double t) {
  along({}, x, psi, nullptr, t, -1, &Taylor<double>::v);
  std::vector<double> q;
  for (const auto& along : ws_.along) q.push_back(along.v);
  return q;
}

}  // namespace mixloop
