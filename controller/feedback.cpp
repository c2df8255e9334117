// SPDX-License-Identifier: MIT
#include "controller/feedback.hpp"

#include "dynamics/procedure/decompositions.hpp"

namespace mixloop {

Matrix forward_dynamics_slopes(Equations::Workspace& dynamics, const Vector& psi, const Vector& psid,
                               const Vector& psidd, double t) {
  const auto n = psi.size();
  Vector tau(n);
  dynamics.evaluate(Purpose::inverse_dynamics, {span_of(psi), span_of(psid), span_of(psidd), t},
                    span_of(tau));
  Matrix slopes(n, 3 * n);
  dynamics.evaluate(Purpose::linearisation, {span_of(psi), span_of(psid), span_of(tau), t},
                    {slopes.data(), static_cast<std::size_t>(slopes.size())});
  return slopes;
}

InverseDynamicsSlope inverse_dynamics_slope(Equations::Workspace& dynamics, const Vector& psi,
                                            const Vector& psid, const Vector& psidd, double t) {
  const auto n = psi.size();
  const Matrix slopes = forward_dynamics_slopes(dynamics, psi, psid, psidd, t);
  const Matrix by_state = solved(slopes.rightCols(n), slopes.leftCols(2 * n));
  return {-by_state.leftCols(n), -by_state.rightCols(n)};
}

Feedback feedback(const ControllerSettings& settings, Equations::Workspace& model, const Reference& reference,
                  double t) {
  const auto n = settings.kp.size();
  const Vector psi = reference.psi, psid = reference.psid, psidd = reference.psidd, zero = Vector::Zero(n);
  Feedback result{Matrix::Zero(n, 2 * n), Matrix::Zero(n, 2 * n)};
  result.proportional.leftCols(n) = -Matrix(settings.kp.asDiagonal());
  result.proportional.rightCols(n) = -Matrix(settings.kv.asDiagonal());
  if (settings.feedforward_at == FeedforwardAt::desired) return result;
  switch (settings.law) {
    case Law::pd:
      break;
    case Law::pd_gravity:  // h(psi, 0)
      result.model.leftCols(n) = inverse_dynamics_slope(model, psi, zero, zero, t).by_psi;
      break;
    case Law::pd_feedforward:  // M(psi) psidd_d, the difference of two inverse dynamics
      result.model.leftCols(n) = inverse_dynamics_slope(model, psi, zero, psidd, t).by_psi -
                                 inverse_dynamics_slope(model, psi, zero, zero, t).by_psi;
      break;
    case Law::computed_torque: {
      const auto slope = inverse_dynamics_slope(model, psi, psid, psidd, t);
      result.model << slope.by_psi, slope.by_psid;
      break;
    }
  }
  return result;
}

}  // namespace mixloop
