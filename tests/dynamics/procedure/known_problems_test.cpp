// SPDX-License-Identifier: MIT
// Benchmark problems whose answers are known from two independent derivations each, integrated with RK4 in
// steps so small that its error stays below the last printed digit.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/dynamics/procedure/scene_procedure.hpp"

namespace mixloop {
namespace {

using Vector1 = Eigen::Matrix<double, 1, 1>;

struct Motion {
  double psi = 0, psid = 0;
};

class Problem {
 public:
  explicit Problem(const char* scene)
      : evaluation_(load_scene(std::filesystem::path(MIXLOOP_SCENES) / scene)) {}

  double psidd(const Motion& m) {
    return evaluation_.forward(Vector1(m.psi), Vector1(m.psid), Vector1(0.0))[0];
  }

  /// Free motion over `duration` in steps of about `step`.
  Motion after(double duration, Motion m, double step) {
    const int count = static_cast<int>(std::ceil(duration / step));
    const double dt = duration / count;
    for (int i = 0; i < count; ++i) {
      const auto moved = [&](double h, const Motion& slope) {
        return Motion{m.psi + h * slope.psi, m.psid + h * slope.psid};
      };
      const auto slope = [&](const Motion& at) { return Motion{at.psid, psidd(at)}; };
      const Motion a = slope(m), b = slope(moved(dt / 2, a)), c = slope(moved(dt / 2, b)),
                   d = slope(moved(dt, c));
      m.psi += dt / 6 * (a.psi + 2 * (b.psi + c.psi) + d.psi);
      m.psid += dt / 6 * (a.psid + 2 * (b.psid + c.psid) + d.psid);
    }
    return m;
  }

  EndEffectorState<double> end(const Motion& m) {
    return evaluation_.end(Vector1(m.psi), Vector1(m.psid), Vector1(0.0));
  }
  double energy(const Motion& m) {
    const auto E = evaluation_.energies(Vector1(m.psi), Vector1(m.psid));
    return E.kinetic + E.potential;
  }

 private:
  Procedure<double> evaluation_;
};

TEST(DoubleFourBar, ReducesToOnePendulum) {
  Problem problem("double_four_bar.yaml");
  for (const double theta : {0.0, 0.5, std::numbers::pi / 2, 2.0, -4.0}) {
    const Motion m{theta, 1.5};
    EXPECT_NEAR(problem.psidd(m), 3.5 * 9.81 / 3 * std::sin(theta), 1e-13);
    EXPECT_NEAR(problem.energy(m), 1.5 * m.psid * m.psid + 3.5 * 9.81 * std::cos(theta), 1e-13);
  }
}

TEST(DoubleFourBar, StandsAfterTenSecondsWhereItShould) {
  Problem problem("double_four_bar.yaml");
  const Motion start{0, 1}, m = problem.after(10, start, 2.5e-4);
  const auto B0 = problem.end(m);
  // RK4 and 40,000 roundings leave 2e-12.
  EXPECT_NEAR(B0.position[0], 0.3284581115408, 5e-12);
  EXPECT_NEAR(B0.position[1], 0.9445185381786, 5e-12);
  EXPECT_NEAR(B0.velocity[0], 1.4230514702069, 1e-11);
  EXPECT_NEAR(B0.velocity[1], -0.4948688454870, 1e-11);
  EXPECT_NEAR(problem.energy(m), problem.energy(start), 1e-11);
}

TEST(SpatialSliderCrank, StartsAsDescribed) {
  Problem problem("spatial_slider_crank.yaml");
  const auto slider = problem.end({0, 6});
  EXPECT_NEAR(slider.position[0], 0.2, 1e-16);
  EXPECT_NEAR(slider.position[1], 0, 1e-16);
  EXPECT_NEAR(slider.position[2], 0, 1e-16);
  EXPECT_NEAR(slider.velocity[0], 0.24, 1e-15);
}

TEST(SpatialSliderCrank, MovesAsKnown) {
  Problem problem("spatial_slider_crank.yaml");
  const Motion start{0, 6};
  const Motion half = problem.after(0.5, start, 1e-4);
  EXPECT_NEAR(half.psi, 5.583762553306, 1e-12);
  EXPECT_NEAR(problem.end(half).position[0], 0.184952629778, 1e-12);
  const Motion end = problem.after(4.5, half, 1e-4);
  EXPECT_NEAR(end.psi, 54.333332168308, 5e-12);
  EXPECT_NEAR(end.psid, 11.4949962651, 1e-10);
  EXPECT_NEAR(problem.end(end).position[0], 0.240719573730, 1e-12);
  EXPECT_NEAR(problem.energy(end), problem.energy(start), 1e-12);
}

}  // namespace
}  // namespace mixloop
