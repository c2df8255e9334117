// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "integrators/coefficient.hpp"
#include "integrators/lu.hpp"

namespace mixloop {

/// da/dq and da/dv of accelerations a(t, q, v), n x n each, and da/dt where forces depend on time.
template <class T>
struct AccelerationJacobian {
  Mat<T> by_q, by_v;
  Vec<T> by_t;
};

/// A linearly implicit method with the exact Jacobian J, for q'' = a(t, q, v), in the form of Hairer &
/// Wanner, Solving ODEs II, IV.7 (7.4'):
///   (I / (h gamma) - J) u_i = f(t + alpha_i h, x + sum_j a_ij u_j) + sum_j c_ij u_j / h + gamma_i h f_t
///   x+ = x + sum_i m_i u_i
/// With f = (v, a) the first row gives u_q = h gamma (r_q + u_v), so that a step factors one n x n matrix,
///   (I / (h gamma) - J_v - h gamma J_q) u_v = r_v + h gamma J_q r_q
/// A fixed cost a step: one Jacobian, one factorisation, kStages solutions. What follows (q, v) in x stays as
/// it is.
template <class CoefficientTable, class T>
class Rosenbrock {
 public:
  using Table = CoefficientTable;
  static constexpr std::size_t kStages = Table::kStages;
  static constexpr int kOrder = Table::kOrder;

  /// Of states (q, v, rest), n numbers of q, `size` in all.
  Rosenbrock(Eigen::Index n, Eigen::Index size)
      : n_(n), x_(size), dx_(size), r_q_(n), r_v_(n), W_(n, n), rows_(static_cast<std::size_t>(n)) {
    jacobian_ = {Mat<T>::Zero(n, n), Mat<T>::Zero(n, n), Vec<T>::Zero(n)};
    for (std::size_t i = 0; i < kStages; ++i) {
      u_q_[i] = u_v_[i] = Vec<T>::Zero(n);
      alpha_[i] = coefficient<T>(Table::kAlpha[i]);
      gamma_i_[i] = coefficient<T>(Table::kGammaI[i]);
      m_[i] = coefficient<T>(Table::kM[i]);
      for (std::size_t j = 0; j < i; ++j) {
        a_[i][j] = coefficient<T>(Table::kA[i][j]);
        c_[i][j] = coefficient<T>(Table::kC[i][j]);
      }
    }
  }

  void begin() {}

  /// In place. `rate(stage, c, x, dx)` writes x' at t + c h, `linearise(x, jacobian)` a's Jacobian at t.
  template <class Rate, class Linearise>
  void step(Vec<T>& x, const T& h, const Rate& rate, const Linearise& linearise) {
    const T hg = h * coefficient_gamma_;
    linearise(x, jacobian_);
    W_ = -jacobian_.by_v - hg * jacobian_.by_q;
    for (Eigen::Index i = 0; i < n_; ++i) W_(i, i) += T(1) / hg;
    factor_lu(W_, rows_);
    for (std::size_t i = 0; i < kStages; ++i) stage(i, x, h, hg, rate);
    for (Eigen::Index r = 0; r < n_; ++r) {
      x[r] += sum(m_, u_q_, kStages, r);
      x[n_ + r] += sum(m_, u_v_, kStages, r);
    }
  }

 private:
  template <class Rate>
  void stage(std::size_t i, const Vec<T>& x, const T& h, const T& hg, const Rate& rate) {
    if (!Table::kSameArgument[i]) {
      x_ = x;
      for (Eigen::Index r = 0; r < n_; ++r) {
        x_[r] += sum(a_[i], u_q_, i, r);
        x_[n_ + r] += sum(a_[i], u_v_, i, r);
      }
      rate(static_cast<int>(i), alpha_[i], x_, dx_);
    }
    for (Eigen::Index r = 0; r < n_; ++r) {
      r_q_[r] = dx_[r] + sum(c_[i], u_q_, i, r) / h;
      r_v_[r] = dx_[n_ + r] + sum(c_[i], u_v_, i, r) / h + gamma_i_[i] * h * jacobian_.by_t[r];
    }
    u_v_[i] = r_v_;
    u_v_[i].noalias() += hg * jacobian_.by_q.lazyProduct(r_q_);
    solve_lu(W_, rows_, u_v_[i]);
    u_q_[i] = hg * (r_q_ + u_v_[i]);
  }

  static T sum(const std::array<T, kStages>& weights, const std::array<Vec<T>, kStages>& u, std::size_t count,
               Eigen::Index r) {
    T total(0);
    for (std::size_t j = 0; j < count; ++j) total += weights[j] * u[j][r];
    return total;
  }

  Eigen::Index n_;
  Vec<T> x_, dx_, r_q_, r_v_;
  Mat<T> W_;
  std::vector<int> rows_;
  AccelerationJacobian<T> jacobian_;
  std::array<Vec<T>, kStages> u_q_, u_v_;
  std::array<T, kStages> alpha_{}, gamma_i_{}, m_{};
  std::array<std::array<T, kStages>, kStages> a_{}, c_{};
  T coefficient_gamma_ = coefficient<T>(Table::kGamma);
};

/// RODAS3: order 3, L-stable (the whole left half plane; R goes to 0 at infinity), three evaluations and a
/// Jacobian a step. Sandu et al., Atmospheric Environment 31 (1997) 3459.
struct Rodas3Table {
  static constexpr int kStages = 4, kOrder = 3;
  static constexpr const char* kGamma = "1/2";
  static constexpr const char* kAlpha[] = {"0", "0", "1", "1"};
  static constexpr const char* kGammaI[] = {"1/2", "3/2", "0", "0"};
  static constexpr const char* kA[][3] = {{}, {"0"}, {"2", "0"}, {"2", "0", "1"}};
  static constexpr const char* kC[][3] = {{}, {"4"}, {"1", "-1"}, {"1", "-1", "-8/3"}};
  static constexpr const char* kM[] = {"2", "0", "1", "1"};
  static constexpr bool kSameArgument[] = {false, true, false,
                                           false};  ///< f of the stage before serves again
};
template <class T>
using Rodas3 = Rosenbrock<Rodas3Table, T>;

/// RODAS: order 4, L-stable, six evaluations and a Jacobian a step. Hairer & Wanner, Solving ODEs II, IV.7,
/// and their code RODAS; its coefficients have 16 digits.
struct Rodas4Table {
  static constexpr int kStages = 6, kOrder = 4;
  static constexpr const char* kGamma = "1/4";
  static constexpr const char* kAlpha[] = {"0", "0.386", "0.21", "0.63", "1", "1"};
  static constexpr const char* kGammaI[] = {"1/4", "-0.1043", "0.1035", "-0.3620000000000023e-1", "0", "0"};
  static constexpr const char* kA[][5] = {
      {},
      {"1.544"},
      {"0.9466785280815826", "0.2557011698983284"},
      {"3.314825187068521", "2.896124015972201", "0.9986419139977817"},
      {"1.221224509226641", "6.019134481288629", "12.53708332932087", "-0.6878860361058950"},
      {"1.221224509226641", "6.019134481288629", "12.53708332932087", "-0.6878860361058950", "1"}};
  static constexpr const char* kC[][5] = {
      {},
      {"-5.6688"},
      {"-2.430093356833875", "-0.2063599157091915"},
      {"-0.1073529058151375", "-9.594562251023355", "-20.47028614809616"},
      {"7.496443313967647", "-10.24680431464352", "-33.99990352819905", "11.70890893206160"},
      {"8.083246795921522", "-7.981132988064893", "-31.52159432874371", "16.31930543123136",
       "-6.058818238834054"}};
  static constexpr const char* kM[] = {
      "1.221224509226641", "6.019134481288629", "12.53708332932087", "-0.6878860361058950", "1", "1"};
  static constexpr bool kSameArgument[] = {false, false, false, false, false, false};
};
template <class T>
using Rodas4 = Rosenbrock<Rodas4Table, T>;

}  // namespace mixloop
