// SPDX-License-Identifier: MIT
// Next to the singular poses of the paper's robot: dynamics, inverse kinematics and plans, to 1e-9 rad and
// less.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "loop/experiment.hpp"
#include "planner/inverse_kinematics.hpp"
#include "tests/oracles/mixed_loop_robot.hpp"
#include "tests/oracles/wide.hpp"
#include "tests/stress/figure.hpp"
#include "tests/stress/routes.hpp"
#include "tests/stress/scenes.hpp"

namespace mixloop::stress {
namespace {

using oracle::Wide;
constexpr double kPi = std::numbers::pi;

// The dynamics know nothing of a flat parallelogram (q4 = 180 deg) or a stretched elbow (q5 = 0): the
// constraints are written for the motors, and M is as regular there as elsewhere. Approached to 1e-9 rad and
// less, and met.
TEST(NearSingularDynamics, IsAsExactAsElsewhere) {
  const std::int64_t states = length(60, 4000);
  const SharedScene scene = papers_robot();
  const auto parameters = scene->default_parameters();
  Ruler ruler(scene, parameters);
  auto ways = routes(scene, Purpose::forward_dynamics, true);
  for (Route& route : ways) route.evaluator.set_up(parameters);
  const auto robot = oracle::paper_numbers<double>();
  Figure figure("near_singular_dynamics", "eps x scale x condition", kMostUnits,
                states * static_cast<std::int64_t>(ways.size()));
  for (std::int64_t seed = 1; seed <= states; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const double away = seed % 8 == 0 ? 0 : log_uniform(random, 1e-9, 1e-1), a = uniform(random, 1, kPi)[0];
    // (B-4), (B-5): q4 = pi - a + beta + b, q5 = q5_o - r6 (q4 - gamma_o).
    const double q4 = seed % 2 == 0 ? kPi - away : robot.gamma_o + (robot.q5_o - away) / robot.r6;
    State state{papers_motors(a, q4 - kPi + a - robot.beta), uniform(random, 3, 50), uniform(random, 3, 5)};
    state.psi[0] = uniform(random, 1, 10)[0];
    for (Route& route : ways) {
      std::vector<double> out(3);
      route.evaluator.evaluate(state.arguments(), out);
      figure.look(ruler.error(Purpose::forward_dynamics, state, out), [&] {
        return fmt::format("{}, seed {}, {} rad away, {}", route.name, seed, away, state.text());
      });
    }
  }
}

/// A point on the elbow's circle: e rad from stretched (or folded), seen from the shoulder at the height of
/// L1.
struct Target {
  Eigen::Vector3d point;
  Wide elbow;  ///< that the rounded point has: 2 acos(R / 2 L); negative where it is out of reach
};

Target target(double e, std::mt19937_64& random) {
  const double L = 0.3, R = 2 * L * std::cos(e / 2), up = uniform(random, 1, 1.4)[0],
               turn = uniform(random, 1, kPi)[0];
  Target made;
  made.point << R * std::cos(up) * std::cos(turn), R * std::cos(up) * std::sin(turn), L + R * std::sin(up);
  // 1 - (R / 2 L)^2 = sin^2(e / 2), with the scene's own L: 113 bits leave 1e-15 of it at 1e-9 rad.
  const Wide x = made.point[0], y = made.point[1], z = Wide(made.point[2]) - Wide(0.3),
             whole = 4 * Wide(0.3) * Wide(0.3);
  const Wide squared = 1 - (x * x + y * y + z * z) / whole;
  made.elbow = squared < 0 ? Wide(-1) : Wide(2 * asin(sqrt(squared)));
  return made;
}

/// |E(psi) - point| by the closed form in 113 bits, m, with the scene's lengths.
double miss(const Vector& psi, const Eigen::Vector3d& point) {
  auto numbers = oracle::paper_numbers<Wide>();
  numbers.L1 = numbers.L2 = numbers.L3 = Wide(0.3);
  const oracle::MixedLoopRobot<Wide>::Vector3 at(psi[0], psi[1], psi[2]);
  return static_cast<double>(
      (oracle::MixedLoopRobot<Wide>(numbers).end_effector(at) - point.cast<Wide>()).norm());
}

double elbow_of(const Vector& psi) {
  const auto robot = oracle::paper_numbers<double>();
  return static_cast<double>(oracle::MixedLoopRobot<double>(robot).dependent({psi[0], psi[1], psi[2]})[4]);
}

// The hand is where it was asked for: both ways, however near the elbow is to stretched, or the answer is a
// refusal. psi of up to 20 rad turns joints by its rounding, 20 eps / 16 and what the elbow's gear makes of
// it, r6 = 2: some 4 eps of reach; the arm's formula adds its own dozen operations. Newton's method takes
// what is within 1e-12 of the reach, where it can't come nearer: a point that rounding has put out of reach.
constexpr double kMostMiss = 32, kMostMissOfSearch = 1e-12 / kEps;
const double kReach = 0.9;  // L1 + L2 + L3

/// The motors' way to a point e rad from stretched, as a path comes there: from 0.3 rad, ever halving what is
/// left.
IkOutcome follow(InverseKinematics& ik, double e, const std::mt19937_64& random, Vector& psi) {
  for (double way = 0.3; way > e + 1e-10; way /= 2) {
    std::mt19937_64 same = random;
    const IkOutcome outcome = ik.position(target(e + way, same).point, 0, psi);
    if (outcome != IkOutcome::solved) return outcome;
  }
  return IkOutcome::solved;
}

void search_hand(const std::string& name, InverseKinematics::Method method, double bound) {
  const std::int64_t targets = length(400, 40000);
  const SharedScene scene = papers_robot();
  const std::vector<double> parameters = scene->default_parameters();
  const auto model = make_model<double>(scene, std::span<const double>(parameters));
  InverseKinematics ik(model, method);
  Figure figure(name, "eps x reach", bound, targets);
  std::int64_t refused = 0;
  for (std::int64_t seed = 1; seed <= targets; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const double e = seed % 8 == 0 ? 0 : log_uniform(random, 1e-9, 0.1);
    Vector psi = Eigen::Map<const Vector>(scene->home.data(), 3);
    IkOutcome outcome = IkOutcome::solved;
    if (method == InverseKinematics::Method::newton) outcome = follow(ik, e, random, psi);
    const Target wanted = target(e, random);
    if (outcome == IkOutcome::solved) outcome = ik.position(wanted.point, 0, psi);
    if (outcome != IkOutcome::solved) {
      ++refused;
      continue;
    }
    figure.look(miss(psi, wanted.point) / (kEps * kReach), [&] {
      return fmt::format("seed {}, {} rad from stretched, {}", seed, e, text_of("psi", span_of(psi)));
    });
  }
  figure.note(fmt::format("{} of {} refused", refused, targets));
}

TEST(NearFlatElbow, TheClosedFormsHandIsWhereItWasAskedForOrRefused) {
  search_hand("near_flat_elbow", InverseKinematics::Method::closed_form_if_known, kMostMiss);
}
TEST(NearFlatElbowNewton, TheSearchsHandIsWhereItWasAskedForOrRefused) {
  search_hand("near_flat_elbow_newton", InverseKinematics::Method::newton, kMostMissOfSearch);
}

// The elbow's own angle is lost by its condition number, 1/e: R = 2 L cos(e/2), so a relative error d of R (a
// dozen operations' and that of the squares of x, y and z - L1: 16 eps) moves it by |e^2 - e'^2| <= 8 d.
TEST(ElbowAngle, LosesNoMoreThanOneOverItself) {
  const std::int64_t targets = length(400, 40000);
  const SharedScene scene = papers_robot();
  const std::vector<double> parameters = scene->default_parameters();
  const auto model = make_model<double>(scene, std::span<const double>(parameters));
  InverseKinematics ik(model);
  Figure figure("elbow_angle", "eps / elbow", 8 * 16, targets);
  for (std::int64_t seed = 1; seed <= targets; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const double e = log_uniform(random, 1e-9, 0.5);
    const Target wanted = target(e, random);
    Vector psi = Eigen::Map<const Vector>(scene->home.data(), 3);
    if (ik.position(wanted.point, 0, psi) != IkOutcome::solved) continue;
    const double found = elbow_of(psi), exact = wanted.elbow < 0 ? 0 : static_cast<double>(wanted.elbow);
    // psi's own rounding turns the elbow by up to 30 eps, whatever the elbow is.
    const double off = std::max(0.0, std::abs(found - exact) - 30 * kEps);
    figure.look(off * (std::abs(found) + exact) / kEps,
                [&] { return fmt::format("seed {}, {:.17g} rad instead of {:.17g}", seed, found, exact); });
  }
}

/// The code under which a line is refused; empty where it isn't.
std::string refusal(const std::vector<Override>& overrides) {
  try {
    make_plan(load_experiment(MIXLOOP_EXPERIMENTS "/paper.yaml", overrides));
    return "";
  } catch (const InputError& error) {
    return error.code;
  }
}

std::string text(const Eigen::Vector3d& point) {
  return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", point[0], point[1], point[2]);
}

// The planner refuses a line that ends within a thousandth (of sin q5 at home, 0.72) of the stretched elbow;
// the figure counts those that it lets through or names otherwise.
TEST(PlanToFlatElbow, IsRefusedByName) {
  const std::int64_t lines = length(4, 200);
  Figure figure("plan_to_flat_elbow", "lines let through", 0, lines);
  for (std::int64_t seed = 1; seed <= lines; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const double e = log_uniform(random, 1e-9, 5e-4);
    const double L = 0.3, R = 2 * L * std::cos(e / 2), up = uniform(random, 1, 0.5)[0];
    const Eigen::Vector3d end(R * std::cos(up), 0, L + R * std::sin(up)),
        start(0.9 * end[0], 0, L + 0.9 * R * std::sin(up));
    const std::string code = refusal({{"path.line.from", text(start)}, {"path.line.to", text(end)}});
    figure.look(code == "singular_path" || code == "unreachable" || code == "crosses_branch" ? 0 : 1,
                [&] { return fmt::format("seed {}, {} rad from stretched: '{}'", seed, e, code); });
  }
}

// The flat parallelogram lies on the other elbow's branch: home is taken there, q4 = 150 deg and q5 = -24
// deg.
TEST(PlanToFlatParallelogram, IsRefusedByName) {
  const std::int64_t lines = length(4, 200);
  const auto numbers = oracle::paper_numbers<double>();
  const oracle::MixedLoopRobot<double> robot(numbers);
  const auto at = [&](double a, double q4) {
    const auto psi = papers_motors(a, q4 - kPi + a - numbers.beta);
    return Eigen::Vector3d(psi[0], psi[1], psi[2]);
  };
  Figure figure("plan_to_flat_parallelogram", "lines let through", 0, lines);
  for (std::int64_t seed = 1; seed <= lines; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const double away = log_uniform(random, 1e-9, 4e-4), a = 1 + uniform(random, 1, 0.3)[0];
    const Eigen::Vector3d home = at(a, 150 * kPi / 180);
    const std::string code =
        refusal({{"scene.home", fmt::format("{{psi1: 0, psi2: {:.17g}, psi3: {:.17g}}}", home[1], home[2])},
                 {"path.line.from", text(robot.end_effector(home))},
                 {"path.line.to", text(robot.end_effector(at(a, kPi - away)))}});
    figure.look(code == "singular_path" || code == "crosses_branch" ? 0 : 1,
                [&] { return fmt::format("seed {}, {} rad from flat: '{}'", seed, away, code); });
  }
}

}  // namespace
}  // namespace mixloop::stress
