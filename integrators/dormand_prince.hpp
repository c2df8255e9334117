// SPDX-License-Identifier: MIT
#pragma once

#include "integrators/explicit_runge_kutta.hpp"

namespace mixloop {

/// Dormand and Prince's pair 5(4): order 5, six evaluations a step (the seventh is the next one's first), the
/// estimate of order 4. Stable for h lambda in [-3.3066, 0] and i [-0.9972, 0.9972]. Hairer, Norsett &
/// Wanner, Solving ODEs I, II.5, table 5.2; the dense output is Shampine's, II.6.
struct DormandPrinceTable {
  static constexpr int kStages = 6, kOrder = 5;
  static constexpr const char* kC[kStages] = {"0", "1/5", "3/10", "4/5", "8/9", "1"};
  static constexpr const char* kA[kStages + 1][kStages] = {
      {},
      {"1/5"},
      {"3/40", "9/40"},
      {"44/45", "-56/15", "32/9"},
      {"19372/6561", "-25360/2187", "64448/6561", "-212/729"},
      {"9017/3168", "-355/33", "46732/5247", "49/176", "-5103/18656"},
      {"35/384", nullptr, "500/1113", "125/192", "-2187/6784", "11/84"}};
  static constexpr const char* kE[kStages + 1] = {"71/57600",      nullptr,  "-71/16695", "71/1920",
                                                  "-17253/339200", "22/525", "-1/40"};

  /// |sum e_i k_i|, of order 4.
  template <class T>
  struct Estimate {
    std::array<T, 7> e;
    Estimate() {
      for (std::size_t i = 0; i < 7; ++i) e[i] = kE[i] ? coefficient<T>(kE[i]) : T(0);
    }
    template <class Slopes, class Weights, class Norm>
    T operator()(const Slopes& k, const Weights&, Vec<T>& sum, const Norm& norm) const {
      sum = e[0] * k[0] + e[2] * k[2] + e[3] * k[3] + e[4] * k[4] + e[5] * k[5] + e[6] * k[6];
      return norm(sum);
    }
  };
};

template <class T>
using DormandPrince = ExplicitRungeKutta<DormandPrinceTable, T>;

/// The accepted step's path between its ends, order 4: x(t + theta h), for slopes k_1 to k_7 taken before
/// `accept`.
///   x + theta (D + (1 - theta) (B + theta (D - h k_7 - B + (1 - theta) h sum d_i k_i))),  D = x+ - x, B = h
///   k_1 - D
template <class T>
void dense_output(const Vec<T>& from, const Vec<T>& to, const T& h, const std::array<Vec<T>, 7>& k,
                  const T& theta, Vec<T>& out) {
  static const std::array<T, 7> d = {
      coefficient<T>("-12715105075/11282082432"),  T(0),
      coefficient<T>("87487479700/32700410799"),   coefficient<T>("-10690763975/1880347072"),
      coefficient<T>("701980252875/199316789632"), coefficient<T>("-1453857185/822651844"),
      coefficient<T>("69997945/29380423")};
  for (Eigen::Index r = 0; r < from.size(); ++r) {
    const T D = to[r] - from[r], B = h * k[0][r] - D;
    const T bend =
        d[0] * k[0][r] + d[2] * k[2][r] + d[3] * k[3][r] + d[4] * k[4][r] + d[5] * k[5][r] + d[6] * k[6][r];
    const T rest = T(1) - theta;
    out[r] = from[r] + theta * (D + rest * (B + theta * (D - h * k[6][r] - B + rest * h * bend)));
  }
}

}  // namespace mixloop
