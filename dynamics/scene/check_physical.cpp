// SPDX-License-Identifier: MIT
#include "dynamics/scene/check_physical.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <span>

#include "notation/utf8.hpp"

namespace mixloop {
namespace {

/// The values of a scene's formulas at home at t = 0; throws InputError where one is not finite.
class ValuesAtHome {
 public:
  ValuesAtHome(const Scene& scene, const std::vector<double>& parameters) {
    symbols_.push_back(0.0);
    symbols_.insert(symbols_.end(), parameters.begin(), parameters.end());
    symbols_.insert(symbols_.end(), scene.home.begin(), scene.home.end());
    const auto q0 = symbols_.size();
    for (const auto& coordinate : scene.coordinates) symbols_.push_back(coordinate.home);
    for (const int j : scene.evaluation_order) {
      const auto& coordinate = scene.coordinates[static_cast<std::size_t>(j)];
      symbols_[q0 + static_cast<std::size_t>(j)] =
          of(coordinate.constraint, "the coordinate '" + coordinate.name + "'");
    }
  }

  double of(const Formula& formula, const std::string& what) const {
    const double value =
        evaluate<double>(formula, [&](int symbol) { return symbols_[static_cast<std::size_t>(symbol)]; });
    if (!std::isfinite(value))
      throw InputError("not_finite", formula.place,
                       what + " is not finite at these parameters, at home at t = 0");
    return value;
  }

  void check(std::span<const Formula> formulas, const std::string& what) const {
    for (const auto& formula : formulas) of(formula, what);
  }

  /// Ascending.
  Eigen::Vector3d principal_moments(const Scene::Body& body) const {
    const auto I = [&](std::size_t i) { return of(body.inertia[i], "the inertia"); };
    Eigen::Matrix3d tensor;
    tensor << I(0), I(3), I(4), I(3), I(1), I(5), I(4), I(5), I(2);
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor, Eigen::EigenvaluesOnly).eigenvalues();
  }

 private:
  std::vector<double> symbols_;  ///< in the order of Symbols
};

void check_body(const Scene::Body& body, const ValuesAtHome& values) {
  const double mass = values.of(body.mass, "the mass");
  if (mass < 0)
    throw InputError("negative_mass", body.mass.place,
                     fmt::format("{} has a mass of {} kg; expected 0 or more", in_quotes(body.name), mass));
  values.check(body.center_of_mass, "the centre of mass");
  const Eigen::Vector3d principal = values.principal_moments(body);
  // Rounding of an eigenvalue is a few units in the last place of the largest element.
  if (principal[0] < -1e-14 * std::max(principal.cwiseAbs().maxCoeff(), 1e-300))
    throw InputError(
        "impossible_inertia", body.inertia[0].place,
        fmt::format("{} has a principal moment of inertia of {:.6g} kg m^2 (is it given about another point "
                    "than the centre of mass?); expected none below 0",
                    in_quotes(body.name), principal[0]));
}

/// `moved`: what they act on.
void check_law(const Formula& stiffness, const Formula& rest, const Formula& damping, const char* moved,
               const ValuesAtHome& values) {
  values.of(rest, "the spring's rest position");
  const auto check = [&](const Formula& formula, const char* what) {
    const double value = values.of(formula, what);
    if (value < 0)
      throw InputError(
          "negative_stiffness", formula.place,
          fmt::format("{} is {:.6g}, which drives {} away; expected 0 or more", what, value, moved));
  };
  check(stiffness, "the stiffness");
  check(damping, "the damping");
}

void check_along(const Scene::AlongLoad& load, const ValuesAtHome& values) {
  values.of(load.along, "what a load acts along");
  check_law(load.law.stiffness, load.law.rest, load.law.damping, "what it acts along", values);
}

void check_between(const Scene::BetweenLoad& load, const ValuesAtHome& values) {
  for (const auto& end : load.ends) values.check(end.point, "the load's point");
  check_law(load.law.stiffness, load.law.rest, load.law.damping, "the points", values);
  if (const double rest = values.of(load.law.rest, "the spring's rest length"); rest < 0)
    throw InputError("out_of_range", load.law.rest.place,
                     fmt::format("the rest length between two points is {:.6g} m; expected 0 or more", rest));
}

}  // namespace

void check_physical(const Scene& scene, const std::vector<double>& parameters) {
  const ValuesAtHome values(scene, parameters);
  for (const auto& transform : scene.transforms)
    for (const auto* formula : {&transform.theta, &transform.s, &transform.a, &transform.alpha})
      values.of(*formula, "the transform's number");
  for (const auto& body : scene.bodies) check_body(body, values);
  for (const auto& load : scene.loads) {
    values.check(load.point, "the load's point");
    values.check(load.force, "the load's force");
    values.check(load.moment, "the load's moment");
  }
  for (const auto& load : scene.coordinate_loads)
    check_law(load.stiffness, load.rest, load.damping, "the coordinate", values);
  for (const auto& load : scene.along_loads) check_along(load, values);
  for (const auto& load : scene.between_loads) check_between(load, values);
  values.check(scene.gravity, "gravity");
  values.check(scene.end_effector.point, "the end effector's point");
  for (const auto& singularity : scene.singularities)
    values.of(singularity.measure, "the singularity's measure");
}

std::vector<std::string> physical_warnings(const Scene& scene) {
  std::vector<std::string> warnings;
  const ValuesAtHome values(scene, scene.default_parameters());
  for (const auto& body : scene.bodies) {
    const Eigen::Vector3d principal = values.principal_moments(body);
    if (principal[2] <= (principal[0] + principal[1]) * (1 + 1e-12)) continue;
    warnings.push_back(
        fmt::format("{}: the largest moment of inertia of {}, {:.6g} kg m^2, exceeds the sum of the others, "
                    "{:.6g}: no real mass is spread so",
                    to_string(body.place), in_quotes(body.name), principal[2], principal[0] + principal[1]));
  }
  return warnings;
}

}  // namespace mixloop
