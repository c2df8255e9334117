// SPDX-License-Identifier: MIT
// A scene with a model and a workspace of its own, whose answers are copies.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/procedure/procedure.hpp"
#include "tests/oracles/multipliers.hpp"

namespace mixloop {

template <class T>
class Procedure {
 public:
  using Vector = oracle::VectorX<T>;
  using Matrix = oracle::MatrixX<T>;

  explicit Procedure(const Scene& scene) : Procedure(scene, scene.default_parameters()) {}
  Procedure(const Scene& scene, const std::vector<double>& parameters)
      : model_(make_model<T>(std::make_shared<const Scene>(scene),
                             std::vector<T>(parameters.begin(), parameters.end()))),
        workspace_(model_) {}

  int n() const { return model_.n(); }

  Matrix mass(const Vector& psi, const T& t = T(0)) {
    return mass_matrix<T>(model_, span(psi), t, workspace_);
  }
  Vector h(const Vector& psi, const Vector& psid, const T& t = T(0)) {
    return bias<T>(model_, span(psi), span(psid), t, workspace_);
  }
  Vector inverse(const Vector& psi, const Vector& psid, const Vector& psidd, const T& t = T(0)) {
    return inverse_dynamics<T>(model_, span(psi), span(psid), span(psidd), t, workspace_);
  }
  Vector forward(const Vector& psi, const Vector& psid, const Vector& tau, const T& t = T(0)) {
    return forward_dynamics<T>(model_, span(psi), span(psid), span(tau), t, workspace_);
  }
  EndEffectorState<T> end(const Vector& psi, const Vector& psid, const Vector& psidd, const T& t = T(0)) {
    return end_effector<T>(model_, span(psi), span(psid), span(psidd), t, workspace_);
  }
  Energy<T> energies(const Vector& psi, const Vector& psid, const T& t = T(0)) {
    return energy<T>(model_, span(psi), span(psid), t, workspace_);
  }

 private:
  static std::span<const T> span(const Vector& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }

  Model<T> model_;
  Workspace<T> workspace_;
};

}  // namespace mixloop
