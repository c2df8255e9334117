// SPDX-License-Identifier: MIT
// Mechanisms whose motion two independent derivations agree on, by every method, without a torque.
#include <gtest/gtest.h>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/equations.hpp"
#include "integrators/integrator.hpp"

namespace mixloop {
namespace {

class Mechanism {
 public:
  explicit Mechanism(const char* file)
      : scene_(std::make_shared<const Scene>(load_scene(std::filesystem::path(MIXLOOP_SCENES) / file))),
        dynamics_(equations_of(scene_, Evaluation::interpreter,
                               {Purpose::forward_dynamics, Purpose::linearisation, Purpose::end_effector}),
                  scene_->default_parameters()) {}

  /// (psi, psi') after free motion.
  Vector after(const IntegratorSettings& settings, double duration, double psi, double psid) {
    Integrator integrator(settings, 1, 2);
    Vector x(2), out(3);
    x << psi, psid;
    integrator.advance(
        x, duration,
        [&](int, int, double t, const Vector& at, Vector& dx) {
          dx[0] = at[1];
          dynamics_.evaluate(Purpose::forward_dynamics, {{at.data(), 1}, {at.data() + 1, 1}, kNoTorque, t},
                             {dx.data() + 1, 1});
        },
        [&](double t, const Vector& at, auto& J) {
          dynamics_.evaluate(Purpose::linearisation, {{at.data(), 1}, {at.data() + 1, 1}, kNoTorque, t},
                             span_of(out));
          J.by_q(0, 0) = out[0], J.by_v(0, 0) = out[1];
        });
    return x;
  }

  double end_x(const Vector& x) {
    Vector out(12);
    const double rest[] = {0};
    dynamics_.evaluate(Purpose::end_effector, {{x.data(), 1}, {x.data() + 1, 1}, rest}, span_of(out));
    return out[0];
  }

 private:
  static constexpr double kNoTorque[] = {0};
  std::shared_ptr<const Scene> scene_;
  Equations::Workspace dynamics_;
};

struct Known {
  Method method;
  int steps_a_second;
  double tolerance;  ///< of the answers: the method's error with these steps, seen and doubled
};

class KnownProblems : public testing::TestWithParam<Known> {};

TEST_P(KnownProblems, DoubleFourBarAfterTenSeconds) {
  const auto& [method, steps, tolerance] = GetParam();
  Mechanism mechanism("double_four_bar.yaml");
  const Vector x = mechanism.after({method, 10 * steps, 0}, 10, 0, 1);
  EXPECT_NEAR(std::sin(x[0]), 0.3284581115408, tolerance);
  EXPECT_NEAR(std::cos(x[0]), 0.9445185381786, tolerance);
  EXPECT_NEAR(x[1] * std::cos(x[0]), 1.4230514702069, 2 * tolerance);
}

TEST_P(KnownProblems, SpatialSliderCrankAfterHalfASecond) {
  const auto& [method, steps, tolerance] = GetParam();
  Mechanism mechanism("spatial_slider_crank.yaml");
  const Vector x = mechanism.after({method, steps / 2, 0}, 0.5, 0, 6);
  EXPECT_NEAR(x[0], 5.583762553306, tolerance);
  EXPECT_NEAR(mechanism.end_x(x), 0.184952629778, tolerance);
}

INSTANTIATE_TEST_SUITE_P(All, KnownProblems,
                         testing::Values(Known{Method::semi_implicit_euler, 20000, 2e-2},
                                         Known{Method::leapfrog, 4000, 2e-5}, Known{Method::rk4, 1000, 2e-8},
                                         Known{Method::dormand_prince, 1000, 3e-11},
                                         Known{Method::dop853, 400, 1e-11}, Known{Method::gauss8, 200, 3e-11},
                                         Known{Method::rodas3, 1000, 1e-5},
                                         Known{Method::rodas4, 1000, 2e-8}),
                         [](const auto& row) { return std::string(facts(row.param.method).name); });

// To the printed digits, but for what hundreds of steps of 1e-14 and 1e-13 may add: 3e-12 and, over the
// crank's nine turns, 2e-10.
TEST(KnownProblems, UnderErrorControl) {
  Mechanism bars("double_four_bar.yaml"), crank("spatial_slider_crank.yaml");
  for (const Method method : {Method::dormand_prince, Method::dop853}) {
    const Vector b = bars.after({method, 1, 1e-14}, 10, 0, 1);
    EXPECT_NEAR(std::sin(b[0]), 0.3284581115408, 3e-12) << facts(method).name;
    EXPECT_NEAR(std::cos(b[0]), 0.9445185381786, 3e-12) << facts(method).name;
    const Vector c = crank.after({method, 1, 1e-13}, 5, 0, 6);
    EXPECT_NEAR(c[0], 54.333332168308, 2e-10) << facts(method).name;
    EXPECT_NEAR(c[1], 11.4949962651, 5e-10) << facts(method).name;
  }
}

}  // namespace
}  // namespace mixloop
