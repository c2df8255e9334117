// SPDX-License-Identifier: MIT
// The three ways to evaluate a purpose, and the ruler that their errors are measured with.
#pragma once

#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "dynamics/procedure/purpose.hpp"
#include "dynamics/procedure/workspace.hpp"
#include "dynamics/program/routine.hpp"

namespace mixloop::stress {

struct State {
  std::vector<double> psi, psid, input;
  double t = 0.0;

  Arguments arguments() const { return {psi, psid, input, t}; }
  std::string text() const;
};

/// size values, each uniform in [-scale, scale].
std::vector<double> uniform(std::mt19937_64& random, int size, double scale);
/// Uniform in the exponent.
double log_uniform(std::mt19937_64& random, double low, double high);

/// A way to evaluate one purpose: `reference`, `interpreter` or `machine_code`.
struct Route {
  Route(std::string named, std::unique_ptr<const Routine> by)
      : name(std::move(named)), routine(std::move(by)), evaluator(*routine) {}

  std::string name;
  std::unique_ptr<const Routine> routine;
  Evaluator evaluator;
};

/// All of them; machine code only where asked for (it takes a compiler a second or so) and to be had.
std::vector<Route> routes(const std::shared_ptr<const Scene>& scene, Purpose purpose, bool machine_code);

/// How large the terms are that the equations of motion are made of, from lengths, masses and rates alone,
/// so that no cancellation makes it small:
///   |D_j| <= R = sum (|a| + |s|) along the chain + |P| for an angle, 1 for a displacement; |O_j| <= 1;
///   g = |C|^T |D|, k = |C|^T |O|  ->  the terms of M_ij <= M_i M_j, M_i^2 = sum_bodies m g_i^2 + |I| k_i^2
///   w = sum |q'_j|, b = sum |q''_j where psi'' = 0|  ->  |Ap| <= R w^2 + 2 w v + R b, |Ao| <= w^2 + b
///   the terms of h_i <= sum_bodies m g_i (|Ap| + |gravity|) + |I| k_i |Ao|, and loads and springs
struct Sizes {
  Vector M, h;  ///< n
  double angle =
      0;  ///< the largest sum of the terms of a body's angles, rad: rounded, it turns by eps times that
};
Sizes sizes(const Model<double>& model, const State& state, Workspace<double>& ws);

/// Holds outputs to the literal procedure in 113 bits.
///
/// The unit is eps times the natural scale, times the condition number where M is solved with. Scaled by
/// S = diag(1 / M_i), M~ = S M S has terms of size 1 (such a scaling leaves nearly the least condition
/// number, van der Sluis, Numer. Math. 14, 1969) and x~ = S^-1 psi'' obeys
///   |dx~| <= |M~^-1| (|dM~| |x~| + |dh~| + eps |tau~|),
/// so that the unit of psi'' is eps |M~^-1| (|x~| + |h~| + |tau~|), of M_ij eps M_i M_j, of h_i eps h_i, of
/// tau_i eps (M_i sum M_j |a_j| + h_i). Angles of some size are rounded themselves: all times 1 + angle / 32.
class Ruler {
 public:
  Ruler(std::shared_ptr<const Scene> scene, std::vector<double> parameters);
  ~Ruler();

  /// Of forward_dynamics, mass_matrix, bias or inverse_dynamics; infinite where an output isn't finite.
  double error(Purpose purpose, const State& state, std::span<const double> outputs);
  /// |M~| |M~^-1| at the last state, Frobenius norms, from 113 bits.
  double condition() const { return condition_; }
  /// The sizes at a state.
  Sizes sizes_at(const State& state);
  /// eps (1 + angle / 32).
  static double unit(const Sizes& sizes);
  /// The error of psi'' that a relative error of one eps in every term brings, |dx~|, at these psi''.
  double unit_of_acceleration(const State& state, std::span<const double> psidd, std::span<const double> tau);

 private:
  double inverse_norm(const State& state, const Sizes& sizes);

  std::shared_ptr<const Scene> scene_;
  std::vector<double> parameters_;
  std::unique_ptr<Model<double>> model_;
  std::unique_ptr<Workspace<double>> ws_;
  double condition_ = 0;
};

/// The bound of all errors in those units, for chains of up to 8 frames, 10 bodies and 8 coordinates, n <= 4.
/// Roundings in first order, in u = eps/2 (Higham, Accuracy and Stability of Numerical Algorithms, 3.1):
///   D: and its product 4 u a frame, the point 4 u                         36 u
///   an angle's rounding                                                         see 1 + angle / 32
///   m D^T D, O^T I O: twice D's, 6 more; the sum over bodies 10                 88 u
///   C and C^T (...) C: 2 (m + 4)                                               112 u
///   h: V' has two products a frame for D's one                                  150 u
///   M^-1: LDL^T 3 n u |L||D||L^T| <= 3 n^2 u; M's own error in norm n times     450 u
/// That no two cancel, and all are as large as they can be, never happens: k roundings add up to lambda
/// sqrt(k) u but with probability 2 exp(-lambda^2 / 2) (Higham & Mary, SIAM J. Sci. Comput. 41, 2019). lambda
/// = 6, 3e-8: 6 sqrt(450) u = 64 eps. What is lost otherwise, digits, shows.
constexpr double kMostUnits = 64;

}  // namespace mixloop::stress
