// SPDX-License-Identifier: MIT
// Denormals: nothing flushes them to zero, and what they are too small for says so by not being finite.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "dynamics/equations.hpp"
#include "tests/stress/figure.hpp"
#include "tests/stress/routes.hpp"
#include "tests/stress/scenes.hpp"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace mixloop::stress {
namespace {

constexpr double kLeast = std::numeric_limits<double>::denorm_min();
constexpr double kLeastNormal = std::numeric_limits<double>::min();

/// Whether denormals are computed with: by the processor's flags, and by trying.
bool denormals_live() {
#if defined(__SSE2__)
  // Flush to zero is bit 15 of MXCSR, denormals are zero bit 6.
  if ((_mm_getcsr() & 0x8040u) != 0) return false;
#endif
  volatile double half = 0.5, least = kLeastNormal;
  return half * least != 0 && half * least + half * least == least;
}

// Loading programs, whose flags are not the project's own, and running them leaves the processor as it was.
TEST(Denormals, AreNotFlushedByAnythingThatIsLoaded) {
  Figure figure("denormals_flushed", "flags set", 0, 4);
  const auto look = [&](const char* when) {
    figure.look(denormals_live() ? 0 : 1, [&] { return std::string(when); });
  };
  look("at the start");
  const SharedScene scene = papers_robot();
  for (const Evaluation how : {Evaluation::reference, Evaluation::interpreter, Evaluation::machine_code}) {
    Equations::Workspace dynamics(equations_of(scene, how, {Purpose::forward_dynamics}),
                                  scene->default_parameters());
    std::vector<double> out(3);
    const std::vector psi{1., 2., 3.}, psid{.1, .2, .3}, tau{0., 0., 0.};
    dynamics.evaluate(Purpose::forward_dynamics, {psi, psid, tau}, out);
    look("after an evaluation");
  }
}

/// Zero, a denormal, a number next to the least normal one, or an ordinary one.
double small_number(std::mt19937_64& random, double ordinary) {
  const double sign = random() % 2 == 0 ? 1 : -1;
  switch (random() % 4) {
    case 0:
      return sign * 0;
    case 1:
      return sign * kLeast * static_cast<double>(1 + random() % 1000000);
    case 2:
      return sign * kLeastNormal * (1 + uniform(random, 1, 0.5)[0]);
    default:
      return uniform(random, 1, ordinary)[0];
  }
}

// States and torques with denormals among them: as exact as others. Where gravity is taken away as well all
// of psi'' may be denormal; a program's intermediate products lose what lies below 4.9e-324 then, some
// hundred of them, in psi'' through M^-1 (up to 5e4 for the motors).
TEST(DenormalStates, AreAsExactAsOthers) {
  const std::int64_t states = length(60, 4000);
  const SharedScene scene = papers_robot();
  const auto parameters = scene->default_parameters();
  Ruler ruler(scene, parameters);
  auto ways = routes(scene, Purpose::forward_dynamics, true);
  for (Route& route : ways) route.evaluator.set_up(parameters);
  Figure figure("denormal_states", "eps x scale x condition", kMostUnits, states * 3);
  for (std::int64_t seed = 1; seed <= states; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    State state;
    for (int i = 0; i < 3; ++i) {
      state.psi.push_back(small_number(random, 10));
      state.psid.push_back(small_number(random, 10));
      state.input.push_back(small_number(random, 5));
    }
    for (Route& route : ways) {
      std::vector<double> out(3);
      route.evaluator.evaluate(state.arguments(), out);
      figure.look(ruler.error(Purpose::forward_dynamics, state, out),
                  [&] { return fmt::format("{}, seed {}, {}", route.name, seed, state.text()); });
    }
  }
}

// One mass on one axis: psi'' = tau / (m r^2), exact to the products' rounding for every m r^2 down to the
// denormals, whose own last place is 4.9e-324; where 1 / (m r^2) or psi'' overflows, it is infinite and not
// some number.
TEST(DenormalMasses, GiveTheirAccelerationOrNone) {
  const std::int64_t masses = length(300, 100000);
  const SharedScene scene = scene_of(
      "parameters: {bob: 1 kg}\nmotors: [psi]\ncoordinates: [q]\nconstraints: {q: psi}\n"
      "transforms:\n  - {from: 0, to: arm, theta: q, a: 1 m}\nbodies:\n  - {frame: arm, mass: "
      "bob}\nend_effector: {frame: arm, axes: [x]}\n");
  auto ways = routes(scene, Purpose::forward_dynamics, true);
  Figure figure("denormal_masses", "eps", 8, masses * 3);
  std::int64_t infinite = 0;
  for (std::int64_t seed = 1; seed <= masses; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const double m = random() % 2 == 0 ? kLeast * static_cast<double>(1 + random() % 1000000)
                                       : log_uniform(random, 1e-300, 1);
    const double tau = random() % 2 == 0 ? m * uniform(random, 1, 10)[0] : uniform(random, 1, 1)[0];
    State state{uniform(random, 1, 10), {0.0}, {tau}};
    const long double exact = static_cast<long double>(tau) / m;
    for (Route& route : ways) {
      double out = 0;
      route.evaluator.set_up(std::span(&m, 1));
      route.evaluator.evaluate(state.arguments(), {&out, 1});
      if (!std::isfinite(out)) {
        // Reported: rightly where 1/m has no finite double.
        ++infinite;
        figure.look(
            1 / m > std::numeric_limits<double>::max() || std::abs(exact) > std::numeric_limits<double>::max()
                ? 0
                : HUGE_VAL,
            [&] {
              return fmt::format("{}, seed {}: m = {}, tau = {}, psidd = {}", route.name, seed, m, tau, out);
            });
        continue;
      }
      // m cos^2 + m sin^2 may each lose half of the least denormal: an error of m's own, dm / m.
      const double of_mass = 4 * kLeast / m;
      const auto off = static_cast<double>(std::abs(out - exact) /
                                           std::max(std::abs(exact), static_cast<long double>(kLeastNormal)));
      figure.look(off / (std::numeric_limits<double>::epsilon() + of_mass), [&] {
        return fmt::format("{}, seed {}: m = {}, tau = {}, psidd = {}", route.name, seed, m, tau, out);
      });
    }
  }
  figure.note(fmt::format("{} of {} not finite", infinite, masses * static_cast<std::int64_t>(ways.size())));
}

}  // namespace
}  // namespace mixloop::stress
