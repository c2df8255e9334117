// SPDX-License-Identifier: MIT
#include "stability/linear_loop.hpp"

#include <fmt/format.h>

namespace mixloop {
namespace {

Dynamics linear_dynamics(const std::shared_ptr<const Scene>& scene, const std::vector<double>& parameters,
                         Evaluation how) {
  return {scene, parameters, how, {Purpose::inverse_dynamics, Purpose::linearisation}};
}

}  // namespace

Linearisation::Linearisation(const Experiment& experiment)
    : settings_(experiment.controller),
      plant_(linear_dynamics(experiment.scene, experiment.plant_parameters, experiment.evaluation)),
      model_(linear_dynamics(experiment.controller_scene, experiment.controller_parameters,
                             experiment.evaluation)) {}

LinearLoop Linearisation::at(const Reference& reference, double t) {
  const auto n = reference.psi.size();
  Vector tau(n);
  plant_.inverse_dynamics(span_of(reference.psi), span_of(reference.psid), span_of(reference.psidd), t,
                          span_of(tau));
  Matrix slopes(n, 3 * n);
  plant_.linearisation(span_of(reference.psi), span_of(reference.psid), span_of(std::as_const(tau)), t,
                       {slopes.data(), static_cast<std::size_t>(slopes.size())});
  if (!slopes.allFinite())
    throw RunFault("singular",
                   fmt::format("the mass matrix is singular at {:.6g} s: nothing to linearise", t));
  LinearLoop loop{Matrix::Zero(2 * n, 2 * n), Matrix::Zero(2 * n, n),
                  feedback(settings_, model_, reference, t)};
  loop.A.topRightCorner(n, n).setIdentity();
  loop.A.bottomRows(n) = slopes.leftCols(2 * n);
  loop.B.bottomRows(n) = slopes.rightCols(n);
  return loop;
}

}  // namespace mixloop
