// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "dynamics/scene/load_scene.hpp"

namespace mixloop {
namespace {

Eigen::Matrix3d inertia_tensor(const std::array<double, 6>& I) {
  Eigen::Matrix3d tensor;
  tensor << I[0], I[3], I[4], I[3], I[1], I[5], I[4], I[5], I[2];
  return tensor;
}

}  // namespace

void check_physical(const Scene& scene, const std::vector<double>& parameters) {
  const auto value = [&](const Formula& formula, const std::string& what) {
    const double number = evaluate<double>(formula, [&](int symbol) { return parameters.at(static_cast<std::size_t>(symbol - Symbols::kParameter0)); });
    if (!std::isfinite(number)) throw InputError("not_finite", formula.place, what + " is not finite at these parameters");
    return number;
  };
  for (const auto& body : scene.bodies) {
    const double mass = value(body.mass, "the mass");
    if (mass < 0) throw InputError("negative_mass", body.mass.place, fmt::format("{} has a mass of {} kg; expected 0 or more", body.name, mass));
    for (const auto& coordinate : body.center_of_mass) value(coordinate, "the centre of mass");
    std::array<double, 6> I{};
    for (std::size_t i = 0; i < 6; ++i) I[i] = value(body.inertia[i], "the inertia");
    const Eigen::Vector3d principal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia_tensor(I), Eigen::EigenvaluesOnly).eigenvalues();
    // Rounding of an eigenvalue is a few units in the last place of the largest element.
    if (principal[0] < -1e-14 * std::max(principal.cwiseAbs().maxCoeff(), 1e-300))
      throw InputError("impossible_inertia", body.place,
                       fmt::format("{} has a principal moment of inertia of {:.6g} kg m^2 (is it given about another point "
                                   "than the centre of mass?); expected none below 0", body.name, principal[0]));
  }
  for (const auto& transform : scene.transforms)
    for (const auto* formula : {&transform.a, &transform.alpha}) value(*formula, "the transform's number");
}

}  // namespace mixloop
