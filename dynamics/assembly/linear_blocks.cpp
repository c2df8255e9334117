// SPDX-License-Identifier: MIT
#include "dynamics/assembly/linear_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dynamics/assembly/seeded.hpp"
#include "dynamics/assembly/structure.hpp"

namespace mixloop {
namespace {

constexpr double kHolds = 1e-11;

/// The nearest fraction of a small denominator, where it is that to round-off.
double snapped(double value, double unit) {
  for (int q = 1; q <= 64; ++q) {
    const double p = std::round(value / unit * q);
    if (std::abs(p) < 1e6 && std::abs(p / q * unit - value) < kHolds * std::max(unit, std::abs(value)))
      return p / q * unit;
  }
  return value;
}

/// An unknown as offset + slopes . psi.
struct Affine {
  double offset = 0;
  Vector slopes;  ///< in SI

  double at(const Vector& psi) const { return offset + slopes.dot(psi); }
};

class Guess {
 public:
  Guess(const Scene& scene, Closing& closing, const Vector& x) : scene_(scene), closing_(closing) {
    const Vector psi = closing.home_psi();
    const Matrix C = closing.rates(x, psi);
    poses_ = poses_about(closing, x, 3);
    for (int u = 0; u < closing.unknowns(); ++u) {
      Affine& guess = of_.emplace_back();
      guess.slopes = C.row(closing.coordinate(u)).transpose();
      for (auto& slope : guess.slopes) slope = snapped(slope, 1);
      guess.offset = x[u] * closing.unit_of_unknown(u) - guess.slopes.dot(psi);
      // A length is no fraction of anything: only nothing is.
      guess.offset = closing.turns(u) ? snapped(guess.offset, std::numbers::pi / 12)
                     : std::abs(guess.offset) < kHolds * scene.size ? 0
                                                                    : guess.offset;
    }
    for (const auto& pose : poses_) rates_.push_back(closing.rates(pose.x, pose.psi));
  }

  const Affine& of(int unknown) const { return of_[static_cast<std::size_t>(unknown)]; }

  /// The rates are home's nearby: worth a proof.
  bool is_likely(const Closing::Part& block) const {
    if (poses_.empty()) return false;
    for (int u : block.unknowns)
      for (const auto& C : rates_)
        if ((C.row(closing_.coordinate(u)).transpose() - of(u).slopes).cwiseAbs().maxCoeff() > 1e-8)
          return false;
    return true;
  }

  /// The block's rows vanish on its formulas wherever the motors are, whatever other unknowns and parameters
  /// are.
  bool holds(const Closing::Part& block, const std::vector<bool>& is_linear) const {
    Seeded seeded(3);
    for (int trial = 0; trial < 8; ++trial) {
      std::vector<double> parameters = scene_.default_parameters();
      if (trial >= 4)
        for (auto& parameter : parameters) parameter *= 1 + 0.3 * seeded.draw();
      Closing closing(scene_, parameters);
      Vector psi(scene_.n()), x(closing.unknowns());
      for (int i = 0; i < scene_.n(); ++i)
        psi[i] = 2.5 * seeded.draw() *
                 (scene_.independent[static_cast<std::size_t>(i)].linear ? scene_.size : 1.0);
      for (int u = 0; u < closing.unknowns(); ++u) {
        const bool mine = std::find(block.unknowns.begin(), block.unknowns.end(), u) != block.unknowns.end();
        x[u] = mine || is_linear[static_cast<std::size_t>(u)] ? of(u).at(psi) / closing.unit_of_unknown(u)
                                                              : 3 * seeded.draw();
      }
      const double t = 3 * seeded.draw();
      if (!(closing.residual(block, x, psi, t).cwiseAbs().maxCoeff() < kHolds)) return false;
    }
    return true;
  }

 private:
  const Scene& scene_;
  Closing& closing_;
  std::vector<ClosedPose> poses_;
  std::vector<Matrix> rates_;
  std::vector<Affine> of_;
};

Formula formula_of(const Affine& affine, const Scene& scene, const Formula& said, const Place& place) {
  using Op = Formula::Operator;
  Formula formula = said;
  formula.place = place;
  const auto add = [&](const Formula::Node& node) {
    formula.nodes.push_back(node);
    return static_cast<int>(formula.nodes.size()) - 1;
  };
  int sum = add({.op = Op::constant, .value = affine.offset});
  const int psi0 = Symbols(scene).psi0;
  for (int i = 0; i < scene.n(); ++i) {
    if (affine.slopes[i] == 0) continue;
    const int slope = add({.op = Op::constant, .value = affine.slopes[i]});
    const int psi = add({.op = Op::symbol, .symbol = psi0 + i});
    const int product = add({.op = Op::multiply, .left = slope, .right = psi});
    sum = add({.op = Op::add, .left = sum, .right = product});
    ++formula.height;
  }
  ++formula.height;
  return formula;
}

}  // namespace

std::vector<bool> linear_blocks(Scene& scene, Closing& closing, const std::vector<Closing::Part>& blocks,
                                const Vector& x) {
  const Guess guess(scene, closing, x);
  std::vector<bool> linear, is_linear(static_cast<std::size_t>(closing.unknowns()), false);
  for (const auto& block : blocks) {
    linear.push_back(guess.is_likely(block) && guess.holds(block, is_linear));
    for (int u : block.unknowns) is_linear[static_cast<std::size_t>(u)] = linear.back();
  }
  for (int u = 0; u < closing.unknowns(); ++u) {
    if (!is_linear[static_cast<std::size_t>(u)]) continue;
    const int j = closing.coordinate(u);
    auto& coordinate = scene.coordinates[static_cast<std::size_t>(j)];
    coordinate.constraint = formula_of(guess.of(u), scene, coordinate.constraint, coordinate.place);
    scene.evaluation_order.insert(scene.evaluation_order.begin(), j);
    scene.linear.push_back(j);
  }
  return linear;
}

}  // namespace mixloop
