// SPDX-License-Identifier: MIT
// One evaluation with the processor's vectors inside it: all angles in one four-lane sine and cosine, and
// the terms of (a, c) and of (a - beta, b), which have the same form, side by side.
#pragma once

#include "bench/hand_tuned.hpp"
#include "bench/hand_tuned_sincos.hpp"

namespace mixloop::hand_tuned {

using Pair = Lanes<2>;
using Quad = Lanes<4>;

inline constexpr double kBeta = 0.99483767363676785885;  // 57 deg

inline Pair lower(Quad v) { return Pair{v[0], v[1]}; }
inline Pair upper(Quad v) { return Pair{v[2], v[3]}; }
inline double sum(Pair v) { return v[0] + v[1]; }

/// Sines and cosines of (a, a - beta) and of (c, b).
struct PairedAngles {
  Pair s_near, c_near, s_far, c_far;

  explicit PairedAngles(const double* psi) {
    const Quad angle =
        ((0.0234375 * psi[0] + Quad{0, -kBeta, kOffsetC, 0}) - psi[1] * Quad{0.0625, 0.0625, 0.1875, 0}) +
        psi[2] * Quad{0, 0, 0.125, -0.0625};
    Quad s, c;
    lane_sincos<4>(angle, &s, &c);
    s_near = lower(s), c_near = lower(c), s_far = upper(s), c_far = upper(c);
  }
};

/// Products of (a, c) in the first lane, of (a - beta, b) in the second.
struct PairedProducts {
  Pair cc, ss, sc, cs, t;
  double ca, c2, s2;

  PairedProducts(const Lumped& n, const PairedAngles& e) {
    const Pair PQ{n.p, n.q};
    const Pair w = PQ * e.c_near, ws = PQ * e.s_near;
    cc = w * e.c_far, ss = ws * e.s_far, sc = ws * e.c_far, cs = w * e.s_far;
    t = Pair{n.k7, n.k6} * e.c_far;
    ca = e.c_near[0], c2 = ca * ca, s2 = ca * e.s_near[0];
  }

  Blocks<double> mass(const Lumped& n, const PairedAngles& e) const {
    const Pair coupling = cc + ss;
    return {((n.j0 + n.k1 * c2) + n.k2 * s2) + sum(e.c_far * t + cc), n.n_yy + 96.0 * coupling[0],
            (n.n_yz - 32.0 * coupling[0]) + 16.0 * coupling[1], n.n_zz};
  }
};

inline void paired_mass_matrix(const Lumped& n, const double* psi, double* M) {
  const PairedAngles e(psi);
  const Blocks<double> block = PairedProducts(n, e).mass(n, e);
  M[1] = -0.375 * (block.yy + block.yz);
  M[2] = -0.375 * (block.yz + block.zz);
  M[0] = 128.0 * block.J - 0.375 * (M[1] + M[2]);
  M[3] = block.yy;
  M[4] = block.yz;
  M[5] = block.zz;
}

inline void paired_forward_dynamics(const Lumped& n, const double* psi, const double* psid, const double* tau,
                                    double* psidd) {
  const PairedAngles e(psi);
  const PairedProducts m(n, e);
  const Blocks<double> M = m.mass(n, e);
  const double x = 0.375 * psid[0], y = x - psid[1], z = x - psid[2];
  const Pair rate{3.0 * y - 2.0 * z, z};
  const double twice = psid[0] + psid[0], spin = twice * twice;
  // Minus the gradient of J / 8192: by a, and by (c, b).
  const double Ja = sum(m.sc) + (n.k2 + ((2.0 * n.k1) * m.s2 - (2.0 * n.k2) * m.c2));
  const Pair Jcb = (m.t + m.t) * e.s_far + m.cs;
  const Pair swing = m.sc - m.cs;
  const Pair H = (spin * Jcb - swing * (y * y)) + Pair{n.g_c, n.g_b} * e.c_far;
  const double Ha = (spin * Ja + sum(swing * (rate * rate))) + (n.g_cos_a * m.ca + n.g_sin_a * e.s_near[0]);
  const double fy = tau[1] + (Ha + 3.0 * H[0]), fz = tau[2] + (H[1] - 2.0 * H[0]);
  const double J_rate = (0.0625 * psid[0]) * (Ja * y + sum(Jcb * rate));
  const double torque = 0.0078125 * tau[0] + 0.0029296875 * (tau[1] + tau[2]);
  const double scale = 1.0 / (M.yy * M.zz - M.yz * M.yz);
  const double psi1 = (torque + J_rate) / M.J, up = 0.375 * psi1;
  psidd[0] = psi1;
  psidd[1] = up + (M.zz * fy - M.yz * fz) * scale;
  psidd[2] = up + (M.yy * fz - M.yz * fy) * scale;
}

}  // namespace mixloop::hand_tuned
