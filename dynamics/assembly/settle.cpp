// SPDX-License-Identifier: MIT
#include "dynamics/assembly/settle.hpp"

#include <cmath>
#include <numbers>

#include "dynamics/procedure/decompositions.hpp"

namespace mixloop {
namespace {

constexpr int kMostIterations = 200;
constexpr double kLongestStep = 0.5;  // rad, or of the size
constexpr double kCloses = 1e-12;

double largest_part(const Vector& r) { return r.size() == 0 ? 0.0 : r.cwiseAbs().maxCoeff(); }

Vector moved(const Closing::Part& part, const Vector& x, const Vector& step) {
  Vector to = x;
  for (std::size_t i = 0; i < part.unknowns.size(); ++i)
    to[part.unknowns[i]] += step[static_cast<Eigen::Index>(i)];
  return to;
}

}  // namespace

Settled settle(Closing& closing, const Closing::Part& part, Vector& x, const Vector& psi, double t) {
  Settled result;
  Vector r = closing.residual(part, x, psi, t);
  double damping = 0;
  for (; !part.unknowns.empty() && result.iterations < kMostIterations; ++result.iterations) {
    if (!r.allFinite()) break;
    const SingularValues slopes = singular_values(closing.slopes(part, x, psi, t));
    if (slopes.s.size() == 0 || !(slopes.s[0] > 0)) break;
    bool went = false;
    for (int tries = 0; tries < 12 && !went; ++tries) {
      Vector step = slopes.solve(-r, 1e-11, damping * slopes.s[0]);
      const double length = largest_part(step);
      if (length > kLongestStep) step *= kLongestStep / length;
      const Vector to = moved(part, x, step);
      const Vector there = closing.residual(part, to, psi, t);
      went = there.allFinite() && there.norm() < r.norm();
      if (!went) {
        damping = damping == 0 ? 1e-3 : damping * 8;
        continue;
      }
      damping = damping < 1e-6 ? 0 : damping / 8;
      x = to;
      r = there;
    }
    if (!went) break;  // round-off, or nothing nearer
  }
  result.residual = largest_part(r);
  result.closes = result.residual < kCloses;
  return result;
}

double apart(const Closing& closing, const Closing::Part& part, const Vector& one, const Vector& other) {
  double sum = 0;
  for (int i : part.unknowns) {
    double d = one[i] - other[i];
    if (closing.turns(i)) d = std::remainder(d, 2 * std::numbers::pi);
    sum += d * d;
  }
  return std::sqrt(sum);
}

void unwind(const Closing& closing, Vector& x, const Vector& guess) {
  for (int i = 0; i < closing.unknowns(); ++i)
    if (closing.turns(i)) x[i] = guess[i] + std::remainder(x[i] - guess[i], 2 * std::numbers::pi);
}

}  // namespace mixloop
