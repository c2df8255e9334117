// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "dynamics/procedure/coordinates_along.hpp"

namespace mixloop {

/// All rows of a scene's closures as a function of the coordinates without a formula (`unknowns`), on
/// numbers: what puts a mechanism together looks at. Angles in rad, lengths in units of the scene's size, in
/// unknowns and in rows.
class Closing {
 public:
  /// `parameters` may differ from the defaults.
  Closing(const Scene& scene, std::span<const double> parameters);

  const Scene& scene() const { return *scene_; }
  int unknowns() const { return static_cast<int>(unknowns_.size()); }
  int rows() const { return static_cast<int>(rows_.size()); }
  int coordinate(int unknown) const { return unknowns_[static_cast<std::size_t>(unknown)]; }
  const Scene::ClosureRow& row(int row) const { return rows_[static_cast<std::size_t>(row)]; }
  /// m of a length, 1 of an angle.
  double unit_of_unknown(int unknown) const { return unit_[static_cast<std::size_t>(unknown)]; }
  double unit_of_row(int row) const { return row_unit_[static_cast<std::size_t>(row)]; }

  bool turns(int unknown) const;  ///< whether it is an angle
  bool is_length(int row) const { return row_is_length_[static_cast<std::size_t>(row)]; }

  Vector home_psi() const;
  /// The guesses, or where the scene is assembled, the solution.
  Vector home() const;

  /// Some of the rows and of the unknowns.
  struct Part {
    std::vector<int> unknowns, rows;
  };
  Part whole() const;

  /// Of the part's rows, at x (all unknowns).
  Vector residual(const Part& part, const Vector& x, const Vector& psi, double t = 0);
  /// The part's rows by its unknowns.
  Matrix slopes(const Part& part, const Vector& x, const Vector& psi, double t = 0);
  /// The part's rows by the independent coordinates.
  Matrix slopes_by_psi(const Part& part, const Vector& x, const Vector& psi, double t = 0);
  /// Of all coordinates by the independent ones, m x n, in SI, where the mechanism is closed.
  Matrix rates(const Vector& x, const Vector& psi, double t = 0);
  /// A formula's value there.
  double value_at(const Formula& formula, const Vector& x, const Vector& psi);
  /// All coordinates, m, at x and psi, in SI.
  std::vector<double> coordinates(const Vector& x, const Vector& psi, double t = 0);

 private:
  using Along = detail::CoordinatesAlong<double>;
  Vector along(const Part& part, const Vector& x, const Vector& psi, const double* dpsi, double t, int moving,
               double Taylor<double>::*which);

  std::shared_ptr<const Scene> scene_;
  std::vector<int> unknowns_;
  std::vector<Scene::ClosureRow> rows_;
  std::vector<double> unit_, row_unit_;
  std::vector<bool> row_is_length_;
  Model<double> model_;
  Workspace<double> ws_;
};

/// A length typical of the mechanism, m: the largest of its transforms' and its closures' points.
double size_of(const Scene& scene);

}  // namespace mixloop
