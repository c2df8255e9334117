// SPDX-License-Identifier: MIT
// Springs and dampers along formulas and between points, against what their f alone says: differences of it
// in 113 bits, f being worked out by other ways than theirs.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/dynamics/procedure/scene_procedure.hpp"
#include "tests/oracles/in_wide.hpp"
#include "tests/oracles/random_mechanism.hpp"

namespace mixloop {
namespace {

using oracle::RandomMechanism;
using WideX = oracle::VectorX<Wide>;

#ifdef __OPTIMIZE__
constexpr std::uint64_t kMechanisms = 40;
#else
constexpr std::uint64_t kMechanisms = 6;
#endif

Scene scene_of_text(const std::string& text) { return load_scene(parse_document(text, "loaded.yaml")); }

/// A random mechanism without loads, with one, and the f that the load acts along, told apart from it.
struct LoadedMechanism {
  Scene bare, loaded;
  std::function<Wide(const WideX& psi, const Wide& t)> f;
};

Wide place_along(const RandomMechanism& mechanism, const WideX& psi, const Wide& t) {
  const auto q = mechanism.constraints<Wide>(psi, WideX::Zero(psi.size()), t).q;
  return q[0] * q[0] / 4 - q[mechanism.m() - 1] + sin(Wide(psi[0] * 2)) + psi[mechanism.n() - 1] * t / 8;
}

LoadedMechanism along_a_formula(const RandomMechanism& mechanism, const std::string& law) {
  const std::string text = mechanism.scene_text();
  const Scene bare = scene_of_text(text);
  const auto pure = [&](int j) {
    const bool slides =
        bare.coordinates[static_cast<std::size_t>(j)].constraint.dimension.same_powers(kLength);
    return fmt::format("q{}{}", j + 1, slides ? " / (1 m)" : "");
  };
  const std::string formula = fmt::format("({})^2 / 4 - {} + sin(psi1 * 2) + psi{} * t / (8 s)", pure(0),
                                          pure(mechanism.m() - 1), mechanism.n());
  return {bare, scene_of_text(text + fmt::format("loads: [{{along: \"{}\", {}}}]\n", formula, law)),
          [&mechanism](const WideX& psi, const Wide& t) { return place_along(mechanism, psi, t); }};
}

/// From a point of an inner frame (or the ground) to one of the last that has a joint.
LoadedMechanism between_two_points(const RandomMechanism& mechanism, const std::string& law) {
  const std::string text = mechanism.scene_text();
  const Scene bare = scene_of_text(text);
  std::size_t last = bare.transforms.size();
  while (!bare.transforms[last - 1].coordinate) --last;
  const std::size_t inner = last % 3 == 0 ? 0 : last / 2;
  const auto with_end = [&](std::size_t frame, std::array<double, 3> point) {
    Scene other = bare;
    other.end_effector.frame = static_cast<int>(frame);
    for (std::size_t i = 0; i < 3; ++i) other.end_effector.point[i] = constant_formula(point[i], kLength);
    return std::make_shared<Procedure<Wide>>(other);
  };
  const auto one = with_end(inner, {0.25, -0.5, 0.125}), other = with_end(last, {-0.25, 0.125, 0.5});
  return {
      bare,
      scene_of_text(text + fmt::format("loads: [{{between: [{{frame: '{}', point: [0.25, -0.5, 0.125]}}, "
                                       "{{frame: '{}', point: [-0.25, 0.125, 0.5]}}], {}}}]\n",
                                       bare.frames[inner], bare.frames[last], law)),
      [one, other](const WideX& psi, const Wide& t) {
        const WideX rest = WideX::Zero(psi.size());
        return Wide((other->end(psi, rest, rest, t).position - one->end(psi, rest, rest, t).position).norm());
      }};
}

struct Law {
  double stiffness = 0, rest = 0, damping = 0;

  std::string text() const {
    return fmt::format("stiffness: {}, rest: {}, damping: {}", stiffness, rest, damping);
  }
};

// What the motion takes is (k (f - rest) + d f') df/dpsi, and k/2 (f - rest)^2 is held. Central differences,
// of step 1e-10: errors of 1e-20 f''', far below the 1e-15 that is asked for.
void expect_the_laws_share(const LoadedMechanism& mechanism, const Law& law, std::uint64_t seed) {
  const int n = mechanism.bare.n();
  std::mt19937_64 random(seed * 31 + 5);
  const auto draw = [&](double reach) {
    WideX x(n);
    for (int i = 0; i < n; ++i) x[i] = reach * (static_cast<double>(random() % 2049) / 1024 - 1);
    return x;
  };
  const WideX psi = draw(1.5), psid = draw(2);
  const Wide t = 0.375, step(1e-10);
  const Wide f = mechanism.f(psi, t);
  const Wide rate =
      (mechanism.f(psi + step * psid, t + step) - mechanism.f(psi - step * psid, t - step)) / (2 * step);
  WideX expected(n);
  for (int i = 0; i < n; ++i) {
    const WideX e = step * WideX::Unit(n, i);
    expected[i] = (law.stiffness * (f - law.rest) + law.damping * rate) *
                  (mechanism.f(psi + e, t) - mechanism.f(psi - e, t)) / (2 * step);
  }
  Procedure<Wide> bare(mechanism.bare), loaded(mechanism.loaded);
  const WideX taken = loaded.h(psi, psid, t) - bare.h(psi, psid, t);
  EXPECT_LT(static_cast<double>(Wide((taken - expected).norm())),
            1e-15 * (1 + static_cast<double>(expected.norm())));
  const Energy<Wide> with = loaded.energies(psi, psid, t), without = bare.energies(psi, psid, t);
  EXPECT_EQ(with.kinetic, without.kinetic);
  const Wide held = law.stiffness * (f - law.rest) * (f - law.rest) / 2;
  EXPECT_LT(std::abs(static_cast<double>(Wide(with.potential - without.potential - held))),
            1e-28 * (1 + static_cast<double>(Wide(held + abs(without.potential)))));
}

constexpr Law kLaws[] = {{.stiffness = 12, .rest = 0.75, .damping = 3},
                         {.stiffness = 12, .rest = 0.75},
                         {.stiffness = 12},
                         {.damping = 3},
                         {.stiffness = 12, .damping = 3}};

TEST(LineLoads, AlongFormulasActByTheFormulasDerivatives) {
  for (std::uint64_t seed = 0; seed < kMechanisms; ++seed) {
    const RandomMechanism mechanism(seed, {.nonlinear = seed % 2 == 0, .timed = seed % 3 == 0});
    const Law& law = kLaws[seed % std::size(kLaws)];
    SCOPED_TRACE("seed " + std::to_string(seed));
    expect_the_laws_share(along_a_formula(mechanism, law.text()), law, seed);
  }
}

TEST(LineLoads, BetweenPointsActByTheDistancesDerivatives) {
  for (std::uint64_t seed = 0; seed < kMechanisms; ++seed) {
    const RandomMechanism mechanism(seed, {.nonlinear = seed % 2 == 0, .timed = seed % 3 == 0});
    const Law& law = kLaws[seed % std::size(kLaws)];
    SCOPED_TRACE("seed " + std::to_string(seed));
    expect_the_laws_share(between_two_points(mechanism, law.text()), law, seed);
  }
}

// Dampers take the power d f'^2, springs none on the whole.
TEST(LineLoads, DampingTakesThePowerOfItsRateSquared) {
  for (std::uint64_t seed = 0; seed < kMechanisms; ++seed) {
    const RandomMechanism mechanism(seed, {.nonlinear = true});
    const LoadedMechanism loaded = between_two_points(mechanism, "damping: 3");
    const int n = mechanism.n();
    const WideX psi = WideX::Constant(n, Wide(0.25)), psid = WideX::LinSpaced(n, Wide(-1), Wide(2));
    const Wide step(1e-10),
        rate = (loaded.f(psi + step * psid, Wide(0)) - loaded.f(psi - step * psid, Wide(0))) / (2 * step);
    const WideX taken =
        Procedure<Wide>(loaded.loaded).h(psi, psid) - Procedure<Wide>(loaded.bare).h(psi, psid);
    EXPECT_LT(std::abs(static_cast<double>(Wide(psid.dot(taken) - 3 * rate * rate))),
              1e-15 * (1 + static_cast<double>(Wide(rate * rate))))
        << "seed " << seed;
  }
}

/// A 2 kg point on a spring of 50 N/m and 0.6 m, with a damper of 0.5 N s/m, hung at the ground's origin.
constexpr const char* kSpringPendulum = R"(
motors: {angle: rotary, length: linear}
transforms:
  - {from: 0, to: swing, revolute: angle, axis: [0, -1, 0]}
  - {from: swing, to: bob, prismatic: length, axis: [0, 0, -1]}
bodies: [{frame: bob, mass: 2 kg}]
loads: [{between: [{frame: bob}, {frame: 0}], stiffness: 50 N/m, rest: 60 cm, damping: 0.5 N s/m}]
gravity: [0, 0, -9.81 m/s^2]
end_effector: {frame: bob, axes: [x, z]}
)";

// r'' = r angle'^2 + g cos(angle) - k/m (r - rest) - d/m r', angle'' = -(2 r' angle' + g sin(angle)) / r
TEST(LineLoads, ASpringPendulumSwingsByItsClosedForm) {
  Procedure<Wide> pendulum(scene_of_text(kSpringPendulum));
  for (int k = 1; k <= 8; ++k) {
    WideX psi(2), psid(2);
    psi << Wide(k) / 3, Wide(k) / 4;
    psid << Wide(5 - k) / 2, Wide(k - 3) / 5;
    const Wide& r = psi[1];
    const Wide g(9.81), rest(0.6);
    const WideX psidd = pendulum.forward(psi, psid, WideX::Zero(2));
    EXPECT_LT(abs(Wide(psidd[0] + (2 * psid[1] * psid[0] + g * sin(psi[0])) / r)), Wide(1e-30));
    EXPECT_LT(abs(Wide(psidd[1] - (r * psid[0] * psid[0] + g * cos(psi[0]) - 25 * (r - rest) - psid[1] / 4))),
              Wide(1e-30));
    const Energy<Wide> energy = pendulum.energies(psi, psid);
    EXPECT_LT(abs(Wide(energy.potential - (25 * (r - rest) * (r - rest) - 2 * g * r * cos(psi[0])))),
              Wide(1e-30));
  }
}

// `{coordinate: q}` is `along: q`, to the bit.
TEST(LineLoads, AlongACoordinateIsAtIt) {
  const auto with_load = [](const std::string& load) {
    return Procedure<double>(scene_of_text(R"(
motors: [a]
coordinates: [q]
constraints: {q: a/3 + sin(a)}
transforms: [{from: 0, to: arm, theta: q, a: 1 m}]
bodies: [{frame: arm, mass: 1 kg}]
end_effector: {frame: arm, axes: [x]}
loads: [{)" + load + ", stiffness: 3, rest: 0.5, damping: 0.25}]\n"));
  };
  auto at = with_load("coordinate: q"), along = with_load("along: q");
  Eigen::VectorXd psi(1), psid(1);
  psi << 0.7, psid << -1.1;
  EXPECT_EQ(at.h(psi, psid)[0], along.h(psi, psid)[0]);
  EXPECT_EQ(at.energies(psi, psid).potential, along.energies(psi, psid).potential);
}

}  // namespace
}  // namespace mixloop
