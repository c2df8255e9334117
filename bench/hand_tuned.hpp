// SPDX-License-Identifier: MIT
// The paper's robot as an expert would write it by hand: the yardstick for compiled programs.
//
// Rates in which M is block diagonal: psi1', y' = 16 a', z' = 16 b' (a = q2, b = q3 are absolute angles of
// the arm's plane), so that 16 a = 3/8 psi1 - psi2 and 16 b = 3/8 psi1 - psi3; link 3 stands at
// c = 3 a - 2 b - 198 deg. With Lagrange's T = 1/2 J(a, b, c) q1'^2 + 1/2 (a', b') N (a', b')^T,
//   J = J0 + K1 cos^2 a + K2 cos a sin a + K6 cos^2 b + K7 cos^2 c
//          + 2 P cos a cos c + 2 Q cos(a - beta) cos b,
//   N couples a with c by P cos(a - c) and a with b by Q cos(a - beta - b),
// the products of sines and cosines that J, its gradient, N and the centrifugal terms need are the same
// eight: 125 operations and three sine/cosine pairs for forward dynamics, 51 for M,
// 59 for M a, 141 for forward dynamics and M a together. J is kept as J / 8192 and P, Q as P / 4096, Q /
// 4096, which makes most factors one.
#pragma once

namespace mixloop::hand_tuned {

/// All that the evaluation needs to know, lumped. Constant expressions, so that with the payload known
/// they are folded into the code; made once at run time they carry a payload that may change.
struct Lumped {
  double j0, k1, k2, k6, k7;          // J / 8192
  double p, q, q_cos, q_sin;          // P / 4096; Q / 4096 (1, cos beta, sin beta)
  double n_yy, n_yz, n_zz;            // constant part of N / 256
  double g_cos_a, g_sin_a, g_b, g_c;  // gravity / 16
};

constexpr Lumped lump(double payload, double gravity = 9.81) {
  constexpr double cos_beta = 0.54463903501502708222, sin_beta = 0.83867056794542402964;  // 57 deg
  constexpr double L2 = 0.3, L3 = 0.3, L4 = 0.15, L5 = 0.26;
  constexpr double m2 = 3.11, m3 = 0.22, m4 = 0.15, m5 = 0.06, m6 = 0.15;
  // Centres of mass from the joint that each link turns on; link 6 hangs back by w6 from link 4's end.
  constexpr double x2 = L2 - 0.125, y2 = -0.043, l3 = L3 - 0.188, l4 = L4 - 0.1, l5 = L5 - 0.13, w6 = 0.05;
  const double tip = m3 + payload;
  const double moment_c = m3 * l3 + payload * L3;
  const double square_c = m3 * l3 * l3 + payload * L3 * L3;
  const double square_5 = m5 * l5 * l5 + 0.004 + m6 * L5 * L5;  // I_yy - I_xx of link 5
  const double P = L2 * moment_c, Q = m5 * L4 * l5 + m6 * w6 * L5;
  const double moment_5 = m5 * l5 + m6 * L5, moment_b = m4 * l4 + m5 * L4 + m6 * w6;

  const double J0 = 0.008 + m2 * y2 * y2 + 0.003 + 0.004 + 0.010 + 0.010 + square_5 * sin_beta * sin_beta;
  const double K1 = m2 * (x2 * x2 - y2 * y2) + 0.010 + tip * L2 * L2 +
                    square_5 * (cos_beta * cos_beta - sin_beta * sin_beta);
  const double K2 = -2 * m2 * x2 * y2 + 2 * square_5 * cos_beta * sin_beta;
  const double K6 = m4 * l4 * l4 + 0.005 + m5 * L4 * L4 + m6 * w6 * w6 + 0.005;
  const double K7 = square_c + 0.016;
  const double N_a = m2 * (x2 * x2 + y2 * y2) + 0.016 + tip * L2 * L2 + m5 * l5 * l5 + 0.004 + m6 * L5 * L5;
  const double N_b = m4 * l4 * l4 + 0.02 + m5 * L4 * L4 + m6 * w6 * w6 + 0.02;
  const double N_c = square_c + 0.02;
  return {.j0 = J0 / 8192,
          .k1 = K1 / 8192,
          .k2 = K2 / 8192,
          .k6 = K6 / 8192,
          .k7 = K7 / 8192,
          .p = P / 4096,
          .q = Q / 4096,
          .q_cos = Q / 4096 * cos_beta,
          .q_sin = Q / 4096 * sin_beta,
          .n_yy = (N_a + 9 * N_c) / 256,
          .n_yz = -6 * N_c / 256,
          .n_zz = (N_b + 4 * N_c) / 256,
          .g_cos_a = gravity / 16 * (m2 * x2 + tip * L2 + moment_5 * cos_beta),
          .g_sin_a = gravity / 16 * (-m2 * y2 + moment_5 * sin_beta),
          .g_b = gravity / 16 * moment_b,
          .g_c = gravity / 16 * moment_c};
}

inline constexpr double kOffsetC = -3.4557519189487724;  // -198 deg

/// Sines and cosines of the three absolute angles. V is a double, or a vector of them (lanes).
template <class V>
struct Angles {
  V sa, ca, sb, cb, sc, cc;
};

/// All three from `sincos(angle, &sine, &cosine)`.
template <class V, class SinCos>
inline Angles<V> three_pairs(const V* psi, SinCos sincos) {
  const V x = 0.0234375 * psi[0];
  const V a = x - 0.0625 * psi[1], b = x - 0.0625 * psi[2], c = (3.0 * a + kOffsetC) - 2.0 * b;
  Angles<V> s;
  sincos(a, &s.sa, &s.ca);
  sincos(b, &s.sb, &s.cb);
  sincos(c, &s.sc, &s.cc);
  return s;
}

/// Two from `sincos`; e(c) = e(a) e(2 (a - b)) e(-198 deg), for where a sine is dear (18 operations more).
template <class V, class SinCos>
inline Angles<V> two_pairs(const V* psi, SinCos sincos) {
  constexpr double cos_k = -0.95105651629515357212, sin_k = 0.30901699437494742410;
  const V x = 0.0234375 * psi[0];
  const V a = x - 0.0625 * psi[1], d = 0.0625 * (psi[2] - psi[1]);
  Angles<V> s;
  V sd, cd;
  sincos(a, &s.sa, &s.ca);
  sincos(d, &sd, &cd);
  s.cb = s.ca * cd + s.sa * sd;
  s.sb = s.sa * cd - s.ca * sd;
  const V twice = cd + cd;
  const V c2 = twice * cd - 1.0, s2 = twice * sd;
  const V ck = c2 * cos_k - s2 * sin_k, sk = s2 * cos_k + c2 * sin_k;
  s.cc = s.ca * ck - s.sa * sk;
  s.sc = s.sa * ck + s.ca * sk;
  return s;
}

/// M in blocks: psi1'' has 128 J, (y'', z'') the symmetric 2 x 2.
template <class V>
struct Blocks {
  V J, yy, yz;
  double zz;
};

/// The eight products and what mass and bias share.
template <class V>
struct Shared {
  V pc, ps, P1, P2, P3, P4, Q1, Q2, Q3, Q4, t6, t7, c2, s2;

  Shared(const Lumped& n, const Angles<V>& s) {
    const V w = n.p * s.ca, ws = n.p * s.sa;
    pc = n.q_cos * s.ca + n.q_sin * s.sa;
    ps = n.q_cos * s.sa - n.q_sin * s.ca;
    P1 = w * s.cc, P2 = ws * s.sc, P3 = ws * s.cc, P4 = w * s.sc;
    Q1 = pc * s.cb, Q2 = ps * s.sb, Q3 = ps * s.cb, Q4 = pc * s.sb;
    t6 = n.k6 * s.cb, t7 = n.k7 * s.cc;
    c2 = s.ca * s.ca, s2 = s.ca * s.sa;
  }

  Blocks<V> mass(const Lumped& n, const Angles<V>& s) const {
    const V P = P1 + P2;
    return {((n.j0 + n.k1 * c2) + n.k2 * s2) + ((s.cb * t6 + P1) + (s.cc * t7 + Q1)), n.n_yy + 96.0 * P,
            (n.n_yz - 32.0 * P) + 16.0 * (Q1 + Q2), n.n_zz};
  }
};

/// Forces on (psi1, y, z) that the rates and gravity take. The first is kept divided by -128.
template <class V>
struct Bias {
  V J_rate, y, z;
};

template <class V>
inline Bias<V> bias_in_blocks(const Lumped& n, const Angles<V>& s, const Shared<V>& m, const V* psid,
                              const V& y, const V& z) {
  const V c = 3.0 * y - 2.0 * z;
  // Minus the gradient of J / 8192 by a, b and c.
  const V Ja = (m.P3 + m.Q3) + (n.k2 + ((2.0 * n.k1) * m.s2 - (2.0 * n.k2) * m.c2));
  const V Jb = (m.t6 + m.t6) * s.sb + m.Q4, Jc = (m.t7 + m.t7) * s.sc + m.P4;
  const V S = m.P3 - m.P4, U = m.Q3 - m.Q4;
  const V twice = psid[0] + psid[0], spin = twice * twice, yy = y * y;
  const V Ha = ((spin * Ja + S * (c * c)) + U * (z * z)) + (n.g_cos_a * s.ca + n.g_sin_a * s.sa);
  const V Hb = (spin * Jb - U * yy) + n.g_b * s.cb;
  const V Hc = (spin * Jc - S * yy) + n.g_c * s.cc;
  return {(0.0625 * psid[0]) * ((Ja * y + Jb * z) + Jc * c), Ha + 3.0 * Hc, Hb - 2.0 * Hc};
}

/// psidd of M psidd + h = tau.
template <class V>
inline void solve(const Blocks<V>& M, const Bias<V>& h, const V* tau, V* psidd) {
  const V torque = 0.0078125 * tau[0] + 0.0029296875 * (tau[1] + tau[2]);
  const V fy = tau[1] + h.y, fz = tau[2] + h.z;  // minus the forces on y and z
  const V scale = 1.0 / (M.yy * M.zz - M.yz * M.yz);
  const V psi1 = (torque + h.J_rate) / M.J, up = 0.375 * psi1;
  psidd[0] = psi1;
  psidd[1] = up + (M.zz * fy - M.yz * fz) * scale;
  psidd[2] = up + (M.yy * fz - M.yz * fy) * scale;
}

template <class V>
inline void forward_dynamics(const Lumped& n, const Angles<V>& s, const V* psid, const V* tau, V* psidd) {
  const V x = 0.375 * psid[0], y = x - psid[1], z = x - psid[2];
  const Shared<V> shared(n, s);
  solve(shared.mass(n, s), bias_in_blocks(n, s, shared, psid, y, z), tau, psidd);
}

/// M a, the feed-forward of (33).
template <class V>
inline void mass_times(const Blocks<V>& M, const V* a, V* force) {
  const V x = 0.375 * a[0], y = x - a[1], z = x - a[2];
  const V fy = M.yy * y + M.yz * z, fz = M.yz * y + M.zz * z;
  force[0] = (128.0 * M.J) * a[0] + 0.375 * (fy + fz);
  force[1] = -fy;
  force[2] = -fz;
}

template <class V>
inline void mass_times(const Lumped& n, const Angles<V>& s, const V* a, V* force) {
  mass_times(Shared<V>(n, s).mass(n, s), a, force);
}

/// Both, from the same blocks.
template <class V>
inline void forward_dynamics_and_mass_times(const Lumped& n, const Angles<V>& s, const V* psid, const V* tau,
                                            const V* a, V* psidd, V* force) {
  const V x = 0.375 * psid[0], y = x - psid[1], z = x - psid[2];
  const Shared<V> shared(n, s);
  const Blocks<V> M = shared.mass(n, s);
  solve(M, bias_in_blocks(n, s, shared, psid, y, z), tau, psidd);
  mass_times(M, a, force);
}

/// M as 11, 12, 13, 22, 23, 33.
template <class V>
inline void mass_matrix(const Lumped& n, const Angles<V>& s, V* M) {
  const Blocks<V> block = Shared<V>(n, s).mass(n, s);
  M[1] = -0.375 * (block.yy + block.yz);
  M[2] = -0.375 * (block.yz + block.zz);
  M[0] = 128.0 * block.J - 0.375 * (M[1] + M[2]);
  M[3] = block.yy;
  M[4] = block.yz;
  M[5] = V{} + block.zz;
}

/// tau = M psidd + h.
template <class V>
inline void inverse_dynamics(const Lumped& n, const Angles<V>& s, const V* psid, const V* psidd, V* tau) {
  const V x = 0.375 * psid[0], y = x - psid[1], z = x - psid[2];
  const V xx = 0.375 * psidd[0], yy = xx - psidd[1], zz = xx - psidd[2];
  const Shared<V> shared(n, s);
  const Blocks<V> M = shared.mass(n, s);
  const Bias<V> h = bias_in_blocks(n, s, shared, psid, y, z);
  const V fy = (M.yy * yy + M.yz * zz) + h.y, fz = (M.yz * yy + M.zz * zz) + h.z;
  tau[0] = 128.0 * (M.J * psidd[0] - h.J_rate) + 0.375 * (fy + fz);
  tau[1] = -fy;
  tau[2] = -fz;
}

}  // namespace mixloop::hand_tuned
