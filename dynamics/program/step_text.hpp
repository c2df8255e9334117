// SPDX-License-Identifier: MIT
// A whole step of a plant in emitted code, its evaluations inlined: what one of them doesn't need of the one
// before, the sines of its pose above all, the processor works out meanwhile.

namespace mixloop_steps {

/// Runge and Kutta's classical method, in the order of integrators/rk4.hpp: the same bits. x = psi, psi', n
/// each, and the work of the n_u inputs, which are held. The step of h s begins `step` of them after t;
/// `acceleration(psi, psid, t, psidd)` writes psi''.
template <int n, int n_u, class Acceleration>
MIXLOOP_INLINE void rk4(double* x, const double* input, double t, double h, int step,
                        const Acceleration& acceleration) {
  constexpr int size = 2 * n + 1;
  double k1[size], k2[size], k3[size], k4[size], y[size];
  const auto rate = [&](const double* at, double c, double* dx) {
    for (int i = 0; i < n; ++i) dx[i] = at[n + i];
    acceleration(at, at + n, t + (step + c) * h, dx + n);
    double power = n_u > 0 ? input[0] * at[n] : 0.0;
    for (int i = 1; i < n_u; ++i) power = power + input[i] * at[n + i];
    dx[2 * n] = power;
  };
  const auto go = [&](double length, const double* k) {
    for (int i = 0; i < size; ++i) y[i] = x[i] + length * k[i];
  };
  rate(x, 0, k1);
  go(h / 2, k1);
  rate(y, 0.5, k2);
  go(h / 2, k2);
  rate(y, 0.5, k3);
  go(h, k3);
  rate(y, 1, k4);
  for (int i = 0; i < size; ++i) x[i] += (h / 6) * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
}

}  // namespace mixloop_steps
