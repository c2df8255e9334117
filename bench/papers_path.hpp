// SPDX-License-Identifier: MIT
// The paper's path as a function of time, in closed form on any scalar: the reference of control: continuous.
#pragma once

#include "dynamics/procedure/taylor.hpp"
#include "tests/oracles/robot_numbers.hpp"

#include "dynamics/procedure/matrix.hpp"

namespace mixloop::bench {

template <class T>
struct MotorReference {
  Vec<T> psi{3}, psid{3}, psidd{3};
};

/// psi_d, psi_d', psi_d'' at time t of the line from (0.3, 0, 0.8) to (-0.3, 0.4, 0.3) m in 1 s by the
/// cycloid (34), elbow q5 > 0: closed inverse kinematics on a Taylor series in t.
template <class T>
MotorReference<T> papers_reference(const T& t) {
  using S = Taylor<T>;
  const auto N = oracle::paper_numbers<T>();
  const auto constant = [](const T& value) { return S(value); };
  const T two_pi = 2 * oracle::pi<T>();
  const S time(t, T(1), T(0)), s = time - sin(constant(two_pi) * time) / constant(two_pi);
  const S x = constant(T(3) / 10) - constant(T(6) / 10) * s, y = constant(T(4) / 10) * s,
          z = constant(T(8) / 10) - constant(T(5) / 10) * s - constant(N.L1);
  const S rho2 = x * x + y * y, rho = sqrt(rho2);
  const S c5 = (rho2 + z * z - constant(N.L2 * N.L2 + N.L3 * N.L3)) / constant(2 * N.L2 * N.L3);
  const S s5 = sqrt(constant(T(1)) - c5 * c5);
  const S q1 = atan2(y, x), q5 = atan2(s5, c5);
  const S q2 = atan2(z, rho) - atan2(constant(N.L3) * s5, constant(N.L2) + constant(N.L3) * c5);
  // (B-5), (B-4), then (B-1) to (B-3), turned round
  const S q4 = constant(N.gamma_o) - (q5 - constant(N.q5_o)) / constant(N.r6);
  const S q3 = q4 - constant(oracle::pi<T>() + N.beta) + q2;
  const S psi1 = constant(N.r1) * q1;
  const S psi2 = constant(N.r2) * (constant((1 + 1 / N.r2) / N.r1) * psi1 - constant(N.r3) * q2);
  const S psi3 = constant(N.r4) * (constant((1 + 1 / N.r4) / N.r1) * psi1 - constant(N.r5) * q3);
  MotorReference<T> result;
  const S* psi[] = {&psi1, &psi2, &psi3};
  for (int i = 0; i < 3; ++i) {
    result.psi[i] = psi[i]->v;
    result.psid[i] = psi[i]->d;
    result.psidd[i] = psi[i]->dd;
  }
  return result;
}

}  // namespace mixloop::bench
