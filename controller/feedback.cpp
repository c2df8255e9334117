// SPDX-License-Identifier: MIT
#include "controller/feedback.hpp"

#include "dynamics/procedure/decompositions.hpp"

namespace mixloop {

Matrix forward_dynamics_slopes(Equations::Workspace& dynamics, const PsiMotion& at, double t) {
  const auto n = at.psi.size(), n_u = static_cast<Eigen::Index>(dynamics.scene().n_u());
  Vector tau(n);
  dynamics.evaluate(Purpose::inverse_dynamics, {span_of(at.psi), span_of(at.psid), span_of(at.psidd), t},
                    span_of(tau));
  Matrix slopes(n, 2 * n + n_u);
  const auto of_motors = span_of(std::as_const(tau)).first(static_cast<std::size_t>(n_u));
  dynamics.evaluate(Purpose::linearisation, {span_of(at.psi), span_of(at.psid), of_motors, t},
                    {slopes.data(), static_cast<std::size_t>(slopes.size())});
  return slopes;
}

InverseDynamicsSlope inverse_dynamics_slope(Equations::Workspace& dynamics, const PsiMotion& at, double t) {
  const auto n = at.psi.size();
  const Matrix slopes = forward_dynamics_slopes(dynamics, at, t);
  const Matrix by_state = solved(slopes.rightCols(n), slopes.leftCols(2 * n));
  return {-by_state.leftCols(n), -by_state.rightCols(n)};
}

Feedback feedback(const ControllerSettings& settings, Equations::Workspace& model, const PsiMotion& at,
                  double t, std::span<const int> of_model) {
  const auto n_u = settings.kp.size(), n = at.psi.size(),
             known = static_cast<Eigen::Index>(model.scene().n());
  const auto place = [&](Eigen::Index i) {
    return of_model.empty() ? i : static_cast<Eigen::Index>(of_model[static_cast<std::size_t>(i)]);
  };
  const auto part = [&](const Vector& x) {
    return Vector(Vector::NullaryExpr(known, [&](Eigen::Index i) { return x[place(i)]; }));
  };
  const PsiMotion of{part(at.psi), part(at.psid), part(at.psidd)};
  const Vector zero = Vector::Zero(known);
  const auto slope = [&](const Vector& psid, const Vector& psidd) {
    return inverse_dynamics_slope(model, {of.psi, psid, psidd}, t);
  };
  Feedback result{Matrix::Zero(n_u, 2 * n), Matrix::Zero(n_u, 2 * n)};
  if (settings.law == Law::state_feedback) result.proportional = -settings.gain;
  if (!has_gains(settings.law)) return result;
  result.proportional.leftCols(n_u) = -Matrix(settings.kp.asDiagonal());
  result.proportional.middleCols(n, n_u) = -Matrix(settings.kv.asDiagonal());
  if (settings.feedforward_at == FeedforwardAt::desired) return result;
  const auto put = [&](const Matrix& by_psi, const Matrix& by_psid) {
    for (Eigen::Index i = 0; i < known; ++i) {
      result.model.col(place(i)) = by_psi.col(i).head(n_u);
      result.model.col(n + place(i)) = by_psid.col(i).head(n_u);
    }
  };
  const Matrix none = Matrix::Zero(known, known);
  switch (settings.law) {
    case Law::pd:
    case Law::torque:
    case Law::state_feedback:
      break;
    case Law::pd_gravity:  // h(psi, 0)
      put(slope(zero, zero).by_psi, none);
      break;
    case Law::pd_feedforward:  // M(psi) psidd_d, the difference of two inverse dynamics
      put(slope(zero, of.psidd).by_psi - slope(zero, zero).by_psi, none);
      break;
    case Law::computed_torque: {
      const auto [by_psi, by_psid] = slope(of.psid, of.psidd);
      put(by_psi, by_psid);
      break;
    }
  }
  return result;
}

}  // namespace mixloop
