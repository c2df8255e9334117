// SPDX-License-Identifier: MIT
// Whole steps of a plant in emitted code, beside what they evaluate: nothing goes through the memory of a
// caller, and while a stage's accelerations are worked out the processor begins the sines of the next one's
// pose, which doesn't wait for them.
//
// x = psi, psi', n each, and the work of the n_u inputs, which are held; `steps` steps of h s from t on;
// `acceleration(psi, psid, t, psidd)` writes psi''. The order of operations is that of integrators/, so that
// the bits are the same.

namespace mixloop_steps {

template <int n, int n_u>
MIXLOOP_INLINE double power(const double* input, const double* psid) {
  double sum = n_u > 0 ? input[0] * psid[0] : 0.0;
  for (int i = 1; i < n_u; ++i) sum = sum + input[i] * psid[i];
  return sum;
}

/// As integrators/rk4.hpp.
template <int n, int n_u, class Acceleration>
MIXLOOP_INLINE void rk4(double* x, const double* input, double t, double h, int steps,
                        const Acceleration& acceleration) {
  constexpr int size = 2 * n + 1;
  double k1[size], k2[size], k3[size], k4[size], y[size];
  for (int step = 0; step < steps; ++step) {
    const auto rate = [&](const double* at, double c, double* dx) {
      for (int i = 0; i < n; ++i) dx[i] = at[n + i];
      acceleration(at, at + n, t + (step + c) * h, dx + n);
      dx[2 * n] = power<n, n_u>(input, at + n);
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
}

/// As integrators/leapfrog.hpp.
template <int n, int n_u, class Acceleration>
MIXLOOP_INLINE void leapfrog(double* x, const double* input, double t, double h, int steps,
                             const Acceleration& acceleration) {
  double a[n], psi[n], psid[n];
  for (int step = 0; step < steps; ++step) {
    const double at = t + (step + 0.5) * h;
    for (int i = 0; i < n; ++i) psi[i] = x[i] + (h / 2) * x[n + i];
    if (step == 0) acceleration(psi, x + n, at, a);
    for (int i = 0; i < n; ++i) psid[i] = x[n + i] + (h / 2) * a[i];
    acceleration(psi, psid, at, a);
    for (int i = 0; i < n; ++i) x[n + i] += h * a[i];
    x[2 * n] += h * power<n, n_u>(input, psid);
    for (int i = 0; i < n; ++i) x[i] = psi[i] + (h / 2) * x[n + i];
  }
}

}  // namespace mixloop_steps
