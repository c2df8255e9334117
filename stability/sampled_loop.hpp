// SPDX-License-Identifier: MIT
#pragma once

#include <complex>

#include "stability/linear_loop.hpp"

namespace mixloop {

/// How far the loop is stretched: its sampling, and its gains.
struct Sampling {
  double tick = 1e-3;  ///< s
  double delay = 0;    ///< s: u(t_k) acts from t_k + delay on
};

/// What a torque that is held over `s` seconds makes of a state: x(s) = Phi x + Gamma u,
///   Phi = e^{As},  Gamma = int_0^s e^{A sigma} d sigma B
/// by the exponential of [[A, B], [0, 0]] s (van Loan 1978).
struct Held {
  Matrix Phi, Gamma;

  Held(const Matrix& A, const Matrix& B, double s);
};

/// The state's transition over one tick with the torque held from command to command, (2n + n_u (d + 1))
/// square, d whole ticks of delay: states (x_k, u_{k-1}, ..., u_{k-d-1}).
///   x_{k+1} = e^{AT} x_k + G_0 u_{k-d} + G_1 u_{k-d-1},  delay = d T + r:
///   G_0 = int_0^{T-r} e^{As} ds B,  G_1 = e^{A(T-r)} int_0^r e^{As} ds B
/// (Astrom & Wittenmark, Computer-Controlled Systems, 3rd ed., section 2.6). `gain` is n_u x 2n.
Matrix sampled_transition(const LinearLoop& loop, const Matrix& gain, const Sampling& sampling);

/// What rounding leaves of an eigenvalue on the unit circle, where two of them meet (its square root).
constexpr double kRadiusRounding = 1e-7;
/// Whether a spectral radius is that of a loop that grows, by itself or by its control.
inline bool grows(double radius) { return !(radius <= 1 + kRadiusRounding); }

/// The largest magnitude of the transition's eigenvalues: the loop is stable below 1.
double sampled_radius(const LinearLoop& loop, const Matrix& gain, const Sampling& sampling);

/// Eigenvalues of A + B gain, 1/s: the poles with control at every instant.
Eigen::VectorXcd poles(const LinearLoop& loop, const Matrix& gain);

/// The largest amplification of a step of length h of the classical Runge-Kutta method over the poles,
/// |1 + z + z^2/2 + z^3/6 + z^4/24| at z = h pole (Hairer & Wanner, Solving ODEs II, IV.2).
double rk4_radius(const Eigen::VectorXcd& poles, double h);

}  // namespace mixloop
