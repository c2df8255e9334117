// SPDX-License-Identifier: MIT
// What must hold for every mechanism, over seeded random ones: trees of revolute and prismatic transforms
// under linear, nonlinear and time-dependent constraints. A failure prints the seed.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "tests/dynamics/procedure/scene_procedure.hpp"
#include "tests/oracles/in_wide.hpp"
#include "tests/oracles/random_mechanism.hpp"

namespace mixloop {
namespace {

using oracle::MechanismKind;
using oracle::RandomMechanism;

using VectorX = oracle::VectorX<double>;
using MatrixX = oracle::MatrixX<double>;
using WideVector = oracle::VectorX<Wide>;
using WideMatrix = oracle::MatrixX<Wide>;

#ifdef __OPTIMIZE__
constexpr std::uint64_t kSeeds = 60;
#else
constexpr std::uint64_t kSeeds = 10;  // wide floats are slow unoptimised
#endif
constexpr MechanismKind kLinear{}, kNonlinear{.nonlinear = true}, kSprung{.nonlinear = true, .springs = true},
    kEverything{.nonlinear = true, .timed = true, .loads = true, .springs = true, .friction = true};

Scene scene_of(const RandomMechanism& mechanism) {
  return load_scene(parse_document(mechanism.scene_text(), "random.yaml"));
}

struct State {
  VectorX psi, psid, input;
  double t = 0;
};

State random_state(std::uint64_t seed, int n) {
  std::mt19937_64 random(seed * 7919 + 1);
  const auto draw = [&](double reach) {
    VectorX x(n);
    for (int i = 0; i < n; ++i) x[i] = reach * (static_cast<double>(random() % 2049) / 1024 - 1);
    return x;
  };
  return {draw(1.5), draw(2), draw(10), static_cast<double>(random() % 2048) / 1024};
}

struct WideState {
  WideVector psi, psid, input;
  Wide t;

  explicit WideState(const State& s)
      : psi(s.psi.cast<Wide>()), psid(s.psid.cast<Wide>()), input(s.input.cast<Wide>()), t(s.t) {}
};

double distance(const auto& left, const auto& right) {
  return static_cast<double>(Wide((left - right).cwiseAbs().maxCoeff()));
}

/// Calls `law(mechanism, scene, state)` for every seed of each kind.
void for_random_mechanisms(std::initializer_list<MechanismKind> kinds, auto&& law) {
  for (const MechanismKind& kind : kinds)
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const RandomMechanism mechanism(seed, kind);
      SCOPED_TRACE("seed " + std::to_string(seed) + (kind.nonlinear ? ", nonlinear" : "") +
                   (kind.timed ? ", timed" : ""));
      law(mechanism, scene_of(mechanism), random_state(seed, mechanism.n()));
      if (testing::Test::HasFatalFailure()) return;
    }
}

// Same numbers in text, double and wide float, so that 113 bits are met but for the augmented solve.
TEST(RandomMechanisms, AgreeWithLagrangeMultipliersInWideFloats) {
  for_random_mechanisms({kLinear, kNonlinear, kEverything},
                        [](const auto& mechanism, const Scene& scene, const State& state) {
                          const WideState s(state);
                          const auto constraints = mechanism.template constraints<Wide>(s.psi, s.psid, s.t);
                          const auto solution = oracle::multiplier_forward_dynamics<Wide>(
                              mechanism.template tree<Wide>(s.t), constraints, s.input);
                          Procedure<Wide> evaluation(scene);
                          const WideVector psidd = evaluation.forward(s.psi, s.psid, s.input, s.t);
                          const double scale = 1 + static_cast<double>(solution.psidd.norm());
                          EXPECT_LT(distance(psidd, solution.psidd), 1e-26 * scale);
                          const WideVector tau = evaluation.inverse(s.psi, s.psid, psidd, s.t);
                          EXPECT_LT(distance(tau, s.input), 1e-26 * scale);
                        });
}

// 1e-10 of the largest acceleration: condition numbers of M up to 1e4, times the rounding of the terms.
TEST(RandomMechanisms, AgreeWithLagrangeMultipliersInDoubles) {
  for_random_mechanisms(
      {kLinear, kNonlinear, kEverything}, [](const auto& mechanism, const Scene& scene, const State& state) {
        const WideState s(state);
        const auto constraints = mechanism.template constraints<Wide>(s.psi, s.psid, s.t);
        const auto solution = oracle::multiplier_forward_dynamics<Wide>(mechanism.template tree<Wide>(s.t),
                                                                        constraints, s.input);
        const VectorX psidd = Procedure<double>(scene).forward(state.psi, state.psid, state.input, state.t);
        EXPECT_LT(distance(psidd.template cast<Wide>(), solution.psidd),
                  1e-10 * (1 + static_cast<double>(solution.psidd.norm())));
      });
}

TEST(RandomMechanisms, InverseDynamicsUndoesForwardDynamics) {
  for_random_mechanisms({kNonlinear, kEverything}, [](const auto&, const Scene& scene, const State& s) {
    Procedure<double> evaluation(scene);
    const VectorX psidd = evaluation.forward(s.psi, s.psid, s.input, s.t);
    const double scale = s.input.norm() + evaluation.h(s.psi, s.psid, s.t).norm();
    EXPECT_LT((evaluation.inverse(s.psi, s.psid, psidd, s.t) - s.input).norm(), 1e-11 * scale);
  });
}

TEST(RandomMechanisms, HaveASymmetricPositiveDefiniteMassMatrix) {
  for_random_mechanisms({kLinear, kNonlinear, kEverything},
                        [](const auto&, const Scene& scene, const State& s) {
                          const MatrixX M = Procedure<double>(scene).mass(s.psi, s.t);
                          EXPECT_TRUE((M.array() == M.transpose().array()).all());
                          EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixX>(M).eigenvalues()[0], 0);
                        });
}

// Bias minus gravity is C(psi, psi') psi' with M' - 2 C skew: psi'^T (M' psi' - 2 (h - h at rest)) = 0.
// M' by a central difference of step 1e-10 in 113 bits: error 1e-20 of M'''.
TEST(RandomMechanisms, MassRateLessTwiceCoriolisIsSkew) {
  for_random_mechanisms({kLinear, kNonlinear}, [](const auto&, const Scene& scene, const State& state) {
    const WideState s(state);
    Procedure<Wide> evaluation(scene);
    const Wide step(1e-10);
    const WideMatrix ahead = evaluation.mass(s.psi + step * s.psid),
                     behind = evaluation.mass(s.psi - step * s.psid);
    const WideVector rest = evaluation.h(s.psi, WideVector::Zero(s.psi.size())),
                     h = evaluation.h(s.psi, s.psid);
    const WideVector M_rate = (ahead - behind) * s.psid / (2 * step);
    EXPECT_LT(std::abs(static_cast<double>(Wide(s.psid.dot(M_rate - 2 * (h - rest))))),
              1e-14 * (1 + static_cast<double>(M_rate.norm())));
  });
}

TEST(RandomMechanisms, MotorPowerIsTheRateOfEnergy) {
  for_random_mechanisms(
      {kLinear, kNonlinear, kSprung}, [](const auto&, const Scene& scene, const State& state) {
        const WideState s(state);
        Procedure<Wide> evaluation(scene);
        const WideVector psidd = evaluation.forward(s.psi, s.psid, s.input);
        const auto total = [&](const Wide& dt) {
          const auto E = evaluation.energies(s.psi + dt * s.psid + dt * dt / 2 * psidd, s.psid + dt * psidd);
          return Wide(E.kinetic + E.potential);
        };
        const Wide step(1e-10), rate = (total(step) - total(-step)) / (2 * step);
        EXPECT_LT(std::abs(static_cast<double>(Wide(rate - s.input.dot(s.psid)))),
                  1e-12 * (1 + static_cast<double>(psidd.norm())));
      });
}

// Lagrange's equations from the energies alone, mixed and time derivatives of the constraints included:
// d/dt dT/dpsi' - dT/dpsi + dV/dpsi = tau. Differences of differences, step 1e-8: error 1e-16, noise 1e-18.
TEST(RandomMechanisms, ObeyLagrangesEquationsWithTimeDependentConstraints) {
  for_random_mechanisms(
      {MechanismKind{.nonlinear = true, .timed = true, .springs = true}},
      [](const auto& mechanism, const Scene& scene, const State& state) {
        const int n = mechanism.n();
        const WideState s(state);
        Procedure<Wide> evaluation(scene);
        const Wide step(1e-8);
        const auto kinetic = [&](const WideVector& psi, const WideVector& psid, const Wide& t) {
          return evaluation.energies(psi, psid, t).kinetic;
        };
        const auto momentum = [&](const WideVector& psi, const WideVector& psid, const Wide& t) {
          WideVector p(n);
          for (int i = 0; i < n; ++i) {
            const WideVector e = WideVector::Unit(n, i);  // T is quadratic in psi': the difference is exact
            p[i] = (kinetic(psi, psid + e, t) - kinetic(psi, psid - e, t)) / 2;
          }
          return p;
        };
        const WideVector psidd = s.input / 4;
        const auto momentum_after = [&](const Wide& dt) {
          return WideVector(
              momentum(s.psi + dt * s.psid + dt * dt / 2 * psidd, s.psid + dt * psidd, s.t + dt));
        };
        WideVector tau = (momentum_after(step) - momentum_after(-step)) / (2 * step);
        for (int i = 0; i < n; ++i) {
          const WideVector e = step * WideVector::Unit(n, i);
          const auto ahead = evaluation.energies(s.psi + e, s.psid, s.t),
                     behind = evaluation.energies(s.psi - e, s.psid, s.t);
          tau[i] -= (ahead.kinetic - behind.kinetic - ahead.potential + behind.potential) / (2 * step);
        }
        EXPECT_LT(distance(evaluation.inverse(s.psi, s.psid, psidd, s.t), tau),
                  1e-11 * (1 + static_cast<double>(tau.norm())));
      });
}

// Jacobian, velocity and acceleration are the wide-float differences of position (step 1e-10).
TEST(RandomMechanisms, EndEffectorDerivativesAreThoseOfItsPosition) {
  for_random_mechanisms(
      {kLinear, kNonlinear, kEverything}, [](const auto& mechanism, const Scene& scene, const State& state) {
        const WideState s(state);
        Procedure<Wide> evaluation(scene);
        const Wide step(1e-10);
        const auto end = evaluation.end(s.psi, s.psid, s.input, s.t);
        const auto along = [&](const Wide& dt) {
          return evaluation.end(s.psi + dt * s.psid + dt * dt / 2 * s.input, s.psid + dt * s.input, s.input,
                                s.t + dt);
        };
        const auto ahead = along(step), behind = along(-step);
        EXPECT_LT(distance(end.velocity, (ahead.position - behind.position) / (2 * step)), 1e-14);
        EXPECT_LT(distance(end.acceleration, (ahead.velocity - behind.velocity) / (2 * step)), 1e-12);
        for (int i = 0; i < mechanism.n(); ++i) {
          const WideVector e = step * WideVector::Unit(mechanism.n(), i);
          const WideVector column = (evaluation.end(s.psi + e, s.psid, s.input, s.t).position -
                                     evaluation.end(s.psi - e, s.psid, s.input, s.t).position) /
                                    (2 * step);
          EXPECT_LT(distance(end.jacobian.col(i), column), 1e-15);
        }
      });
}

}  // namespace
}  // namespace mixloop
