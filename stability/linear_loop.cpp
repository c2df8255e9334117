// SPDX-License-Identifier: MIT
#include "stability/linear_loop.hpp"

#include <fmt/format.h>

#include "dynamics/procedure/singular_mass.hpp"
#include "dynamics/scene/fully_driven.hpp"
#include "loop/measured.hpp"

namespace mixloop {
namespace {

/// A scene that is made for this one linearisation is on no shelf.
Equations::Workspace linear_dynamics(const Experiment& experiment, const std::shared_ptr<const Scene>& scene,
                                     const std::vector<double>& parameters) {
  const bool shared = scene == experiment.scene || scene == experiment.controller_scene;
  return {shelved_equations(shared ? experiment.shelf.get() : nullptr, scene, experiment.evaluation,
                            {Purpose::inverse_dynamics, Purpose::linearisation}),
          parameters};
}

}  // namespace

Linearisation::Linearisation(const Experiment& experiment)
    : scene_(experiment.scene),
      parameters_(experiment.plant_parameters),
      settings_(experiment.controller),
      of_model_(model_coordinates(experiment)),
      plant_(linear_dynamics(experiment, experiment.scene, experiment.plant_parameters)),
      model_(linear_dynamics(experiment, fully_driven(experiment.controller_scene),
                             experiment.controller_parameters)) {}

LinearLoop Linearisation::at(const Reference& reference, double t) {
  const PsiMotion at = wanted_state(settings_, *scene_, reference);
  LinearPlant plant = plant_at(at, t);
  return {std::move(plant.A), std::move(plant.B), feedback(settings_, model_, at, t, of_model_)};
}

LinearPlant Linearisation::plant_at(const PsiMotion& at, double t) {
  const auto n = at.psi.size(), n_u = static_cast<Eigen::Index>(scene_->n_u());
  const Matrix slopes = forward_dynamics_slopes(plant_, at, t);
  if (!slopes.allFinite()) {
    const auto model = make_model<double>(scene_, std::span<const double>(parameters_));
    const auto why = why_mass_is_singular(model, span_of(at.psi), t);
    throw RunFault("singular", fmt::format("at {:.6g} s {}: nothing to linearise", t,
                                           why ? "the mass matrix is singular: " + *why
                                               : "the plant's linearisation is not finite"));
  }
  Vector needed(n);
  plant_.evaluate(Purpose::inverse_dynamics, {span_of(at.psi), span_of(at.psid), span_of(at.psidd), t},
                  span_of(needed));
  LinearPlant plant{
      t, at, needed.head(n_u), needed.tail(n - n_u), Matrix::Zero(2 * n, 2 * n), Matrix::Zero(2 * n, n_u)};
  plant.A.topRightCorner(n, n).setIdentity();
  plant.A.bottomRows(n) = slopes.leftCols(2 * n);
  plant.B.bottomRows(n) = slopes.rightCols(n_u);
  return plant;
}

}  // namespace mixloop
