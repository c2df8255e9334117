// SPDX-License-Identifier: MIT
// M over all poses of the paper's robot, and what happens next to its singular ones.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "dynamics/evaluator.hpp"
#include "dynamics/scene/load_scene.hpp"
#include "loop/experiment.hpp"
#include "notation/document.hpp"
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
constexpr double kEps = std::numeric_limits<double>::epsilon();

/// psi of the angles q2 = a and q3 = b at q1 = 0: (B-2) and (B-3) turned round.
std::vector<double> motors(double a, double b) { return {0, -16 * a, -16 * b}; }

/// M from the scene's machine code.
class MassMatrix {
 public:
  explicit MassMatrix(double payload)
      : scene_(papers_robot()),
        dynamics_(scene_, std::array{payload}, Evaluation::machine_code, {Purpose::mass_matrix}) {}
  Eigen::Matrix3d at(double a, double b) {
    Eigen::Matrix3d M;
    dynamics_.mass_matrix(motors(a, b), 0, {M.data(), 9});
    return M;
  }
  struct Eigenvalues {
    double least, most;
    double condition() const { return least > 0 ? most / least : HUGE_VAL; }
  };
  Eigenvalues eigenvalues(double a, double b) {
    const Eigen::Vector3d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(at(a, b), Eigen::EigenvaluesOnly).eigenvalues();
    return {values[0], values[2]};
  }

 private:
  SharedScene scene_;
  Dynamics dynamics_;
};

/// An upper bound of cond(M), from lengths, masses and inertias alone. M = B^T N B with the constant B of the oracle;
/// cond(M) <= cond(B)^2 lambda_max(N) / lambda_min(N).
///   lambda_max(N) <= trace N <= sum_bodies m (rho^2 + |d rho/da|^2 + |d rho/db|^2) + the moments of inertia
///   lambda_min(N) >= the least of J >= I_yy of body 1 and that of the turning links' own inertia,
///     sum I_n s s^T with s = d angle / d(a, b): (1, 0), (1 + r6, -r6), (0, 1), (1, 0), (0, 1)
double condition_bound(double payload) {
  const auto robot = oracle::paper_numbers<double>(payload);
  struct Part {
    oracle::Link<double> link;
    double reach;                  // from the shoulder axis
    std::array<double, 2> moved;   // |d point / d a|, |d point / d b|
    std::array<double, 2> spin;
  };
  const auto size = [](const oracle::Link<double>& link, double length) { return std::hypot(length + link.x, link.y); };
  const double k = 1 + robot.r6, r = robot.r6;
  oracle::Link<double> load;
  load.mass = payload;
  const double c2 = size(robot.link2, robot.L2), c3 = size(robot.link3, robot.L3), c4 = size(robot.link4, robot.L4),
               c5 = size(robot.link5, robot.L5), c6 = size(robot.link6, robot.L4);
  const Part parts[] = {{robot.link2, c2, {c2, 0}, {1, 0}},
                        {robot.link3, robot.L2 + c3, {robot.L2 + k * c3, r * c3}, {k, -r}},
                        {robot.link4, c4, {0, c4}, {0, 1}},
                        {robot.link5, robot.L4 + c5, {c5, robot.L4}, {1, 0}},
                        {robot.link6, robot.L4 + robot.L5 + c6, {robot.L5, robot.L4 + c6}, {0, 1}},
                        {load, robot.L2 + robot.L3, {robot.L2 + k * robot.L3, r * robot.L3}, {k, -r}}};
  double trace = robot.base_inertia;
  Eigen::Matrix2d own = Eigen::Matrix2d::Zero();
  for (const Part& part : parts) {
    const Eigen::Vector2d spin(part.spin[0], part.spin[1]);
    trace += part.link.mass * (part.reach * part.reach + part.moved[0] * part.moved[0] + part.moved[1] * part.moved[1]) +
             std::max(part.link.I_along, part.link.I_across) + part.link.I_normal * spin.squaredNorm();
    own += part.link.I_normal * spin * spin.transpose();
  }
  const double least = std::min(robot.base_inertia, Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(own).eigenvalues()[0]);
  const Eigen::Vector3d B = oracle::MixedLoopRobot<double>(robot).basis_jacobian().jacobiSvd().singularValues();
  return std::pow(B[0] / B[2], 2) * trace / least;
}

struct Pose {
  double a = 0, b = 0, condition = 0;
};

/// Whether the robot can stand so as it is assembled: parallelogram and elbow on home's side, 0 < q4, q5 < 180 deg.
bool on_home_branch(double a, double b) {
  const auto q = oracle::MixedLoopRobot<double>(oracle::paper_numbers<double>()).dependent({0, -16 * a, -16 * b});
  return std::sin(q[3]) > 0 && std::sin(q[4]) > 0;
}

/// From a grid's worst pose uphill, with steps that halve.
Pose climb(MassMatrix& M, Pose at, double step) {
  while (step > 1e-9) {
    Pose best = at;
    for (const auto& [da, db] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}) {
      const double a = at.a + da * step, b = at.b + db * step, condition = M.eigenvalues(a, b).condition();
      if (condition > best.condition) best = {a, b, condition};
    }
    if (best.condition > at.condition) at = best;
    else step /= 2;
  }
  return at;
}

// M does not depend on q1: the poses are q2 and q3, all of them, also those that the elbow or the parallelogram can't
// take.
void search(const std::string& name, double payload) {
  const std::int64_t grid = length(120, 2000);
  Figure figure(name, "condition number", condition_bound(payload), grid * grid);
  MassMatrix M(payload);
  Pose worst, worst_at_home;
  double least = HUGE_VAL;
  const auto where = [&](double a, double b) { return fmt::format("q2 = {:.4f}, q3 = {:.4f} deg", a * 180 / kPi, b * 180 / kPi); };
  for (std::int64_t i = 0; i < grid; ++i)
    for (std::int64_t j = 0; j < grid; ++j) {
      const double a = 2 * kPi * static_cast<double>(i) / static_cast<double>(grid), b = 2 * kPi * static_cast<double>(j) / static_cast<double>(grid);
      const auto values = M.eigenvalues(a, b);
      least = std::min(least, values.least);
      figure.look(values.condition(), [&] { return where(a, b); });
      if (values.condition() > worst.condition) worst = {a, b, values.condition()};
      if (values.condition() > worst_at_home.condition && on_home_branch(a, b)) worst_at_home = {a, b, values.condition()};
    }
  worst = climb(M, worst, 2 * kPi / static_cast<double>(grid));
  figure.look(worst.condition, [&] { return where(worst.a, worst.b); });
  figure.note(fmt::format("at {}; on home's branch {:.4g} at {}; least eigenvalue {:.4g}", where(worst.a, worst.b), worst_at_home.condition,
                          where(worst_at_home.a, worst_at_home.b), least));
}

TEST(Condition, OfMIsBoundedOverTheWholeWorkspace) { search("condition", 5); }
TEST(ConditionEmpty, OfMIsBoundedOverTheWholeWorkspaceWithoutPayload) { search("condition_empty", 0); }

// The dynamics know nothing of a flat parallelogram (q4 = 180 deg) or a stretched elbow (q5 = 0): the constraints are
// written for the motors, and M is as regular there as elsewhere. Approached to 1e-9 rad and less, and met.
TEST(NearSingularDynamics, IsAsExactAsElsewhere) {
  const std::int64_t states = length(60, 20000);
  const SharedScene scene = papers_robot();
  const auto parameters = scene->default_parameters();
  Ruler ruler(scene, parameters);
  auto ways = routes(scene, Purpose::forward_dynamics, true);
  for (Route& route : ways) route.routine->set_up(parameters);
  const auto robot = oracle::paper_numbers<double>();
  Figure figure("near_singular_dynamics", "eps x scale x condition", kMostUnits, states * static_cast<std::int64_t>(ways.size()));
  for (std::int64_t seed = 1; seed <= states; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const double away = seed % 8 == 0 ? 0 : log_uniform(random, 1e-9, 1e-1), a = uniform(random, 1, kPi)[0];
    // (B-4), (B-5): q4 = pi - a + beta + b, q5 = q5_o - r6 (q4 - gamma_o).
    const double q4 = seed % 2 == 0 ? kPi - away : robot.gamma_o + (robot.q5_o - away) / robot.r6;
    State state{motors(a, q4 - kPi + a - robot.beta), uniform(random, 3, 50), uniform(random, 3, 5)};
    state.psi[0] = uniform(random, 1, 10)[0];
    for (Route& route : ways) {
      std::vector<double> out(3);
      route.routine->evaluate(state.arguments(), out.data());
      figure.look(ruler.error(Purpose::forward_dynamics, state, out), [&] {
        return fmt::format("{}, seed {}, {} rad away, {}", route.name, seed, away, state.text());
      });
    }
  }
}

/// A point on the elbow's circle: e rad from stretched (or folded), seen from the shoulder at the height of L1.
struct Target {
  Eigen::Vector3d point;
  Wide elbow;  ///< that the rounded point has: 2 acos(R / 2 L); negative where it is out of reach
};

Target target(double e, std::mt19937_64& random) {
  const double L = 0.3, R = 2 * L * std::cos(e / 2), up = uniform(random, 1, 1.4)[0], turn = uniform(random, 1, kPi)[0];
  Target made;
  made.point << R * std::cos(up) * std::cos(turn), R * std::cos(up) * std::sin(turn), L + R * std::sin(up);
  // 1 - (R / 2 L)^2 = sin^2(e / 2), with the scene's own L: 113 bits leave 1e-15 of it at 1e-9 rad.
  const Wide x = made.point[0], y = made.point[1], z = Wide(made.point[2]) - Wide(0.3), whole = 4 * Wide(0.3) * Wide(0.3);
  const Wide squared = 1 - (x * x + y * y + z * z) / whole;
  made.elbow = squared < 0 ? Wide(-1) : Wide(2 * asin(sqrt(squared)));
  return made;
}

/// |E(psi) - point| by the closed form in 113 bits, m, with the scene's lengths.
double miss(const Vector& psi, const Eigen::Vector3d& point) {
  auto numbers = oracle::paper_numbers<Wide>();
  numbers.L1 = numbers.L2 = numbers.L3 = Wide(0.3);
  const oracle::MixedLoopRobot<Wide>::Vector3 at(psi[0], psi[1], psi[2]);
  return static_cast<double>((oracle::MixedLoopRobot<Wide>(numbers).end_effector(at) - point.cast<Wide>()).norm());
}

double elbow_of(const Vector& psi) {
  const auto robot = oracle::paper_numbers<double>();
  return static_cast<double>(oracle::MixedLoopRobot<double>(robot).dependent({psi[0], psi[1], psi[2]})[4]);
}

// The hand is where it was asked for: both ways, however near the elbow is to stretched, or the answer is a refusal.
// psi of up to 20 rad turns joints by its rounding, 20 eps / 16 and what the elbow's gear makes of it, r6 = 2: some
// 4 eps of reach; the arm's formula adds its own dozen operations. Newton's method takes what is within 1e-12 of the
// reach, where it can't come nearer: a point that rounding has put out of reach.
constexpr double kMostMiss = 32, kMostMissOfSearch = 1e-12 / kEps;
const double kReach = 0.9;  // L1 + L2 + L3

void search_hand(const std::string& name, InverseKinematics::Method method, double bound) {
  const std::int64_t targets = length(400, 100000);
  const SharedScene scene = papers_robot();
  const std::vector<double> parameters = scene->default_parameters();
  const auto model = make_model<double>(scene, std::span<const double>(parameters));
  InverseKinematics ik(model, method);
  Figure figure(name, "eps x reach", bound, targets);
  std::int64_t refused = 0;
  for (std::int64_t seed = 1; seed <= targets; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const double e = seed % 8 == 0 ? 0 : log_uniform(random, 1e-9, 0.1);
    const Target wanted = target(e, random);
    Vector psi = Eigen::Map<const Vector>(scene->home.data(), 3);
    // Followed as a path does it: from an elbow of 0.3 rad, ever halving what is left.
    std::mt19937_64 again(static_cast<std::uint64_t>(seed));
    if (seed % 8 != 0) log_uniform(again, 1e-9, 0.1);
    IkOutcome outcome = IkOutcome::kSolved;
    for (double way = 0.3; method == InverseKinematics::Method::kNewton && way > e + 1e-10 && outcome == IkOutcome::kSolved; way /= 2) {
      std::mt19937_64 same = again;
      outcome = ik.position(target(e + way, same).point, 0, psi);
    }
    if (outcome == IkOutcome::kSolved) outcome = ik.position(wanted.point, 0, psi);
    if (outcome != IkOutcome::kSolved) {
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
  search_hand("near_flat_elbow", InverseKinematics::Method::kClosedFormIfKnown, kMostMiss);
}
TEST(NearFlatElbowNewton, TheSearchsHandIsWhereItWasAskedForOrRefused) {
  search_hand("near_flat_elbow_newton", InverseKinematics::Method::kNewton, kMostMissOfSearch);
}

// The elbow's own angle is lost by its condition number, 1/e: R = 2 L cos(e/2), so a relative error d of R (a dozen
// operations' and that of the squares of x, y and z - L1: 16 eps) moves it by |e^2 - e'^2| <= 8 d.
TEST(ElbowAngle, LosesNoMoreThanOneOverItself) {
  const std::int64_t targets = length(400, 100000);
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
    if (ik.position(wanted.point, 0, psi) != IkOutcome::kSolved) continue;
    const double found = elbow_of(psi), exact = wanted.elbow < 0 ? 0 : static_cast<double>(wanted.elbow);
    // psi's own rounding turns the elbow by up to 30 eps, whatever the elbow is.
    const double off = std::max(0.0, std::abs(found - exact) - 30 * kEps);
    figure.look(off * (std::abs(found) + exact) / kEps, [&] {
      return fmt::format("seed {}, {:.17g} rad instead of {:.17g}", seed, found, exact);
    });
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

std::string text(const Eigen::Vector3d& point) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", point[0], point[1], point[2]); }

// The planner refuses a line that ends within a thousandth (of sin q5 at home, 0.72) of the stretched elbow; the
// figure counts those that it lets through or names otherwise.
TEST(PlanToFlatElbow, IsRefusedByName) {
  const std::int64_t lines = length(4, 200);
  Figure figure("plan_to_flat_elbow", "lines let through", 0, lines);
  for (std::int64_t seed = 1; seed <= lines; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const double e = log_uniform(random, 1e-9, 5e-4);
    const double L = 0.3, R = 2 * L * std::cos(e / 2), up = uniform(random, 1, 0.5)[0];
    const Eigen::Vector3d end(R * std::cos(up), 0, L + R * std::sin(up)), start(0.9 * end[0], 0, L + 0.9 * R * std::sin(up));
    const std::string code = refusal({{"path.line.from", text(start)}, {"path.line.to", text(end)}});
    figure.look(code == "singular_path" || code == "unreachable" || code == "crosses_branch" ? 0 : 1,
                [&] { return fmt::format("seed {}, {} rad from stretched: '{}'", seed, e, code); });
  }
}

// The flat parallelogram lies on the other elbow's branch: home is taken there, q4 = 150 deg and q5 = -24 deg.
TEST(PlanToFlatParallelogram, IsRefusedByName) {
  const std::int64_t lines = length(4, 200);
  const auto numbers = oracle::paper_numbers<double>();
  const oracle::MixedLoopRobot<double> robot(numbers);
  const auto at = [&](double a, double q4) {
    const auto psi = motors(a, q4 - kPi + a - numbers.beta);
    return Eigen::Vector3d(psi[0], psi[1], psi[2]);
  };
  Figure figure("plan_to_flat_parallelogram", "lines let through", 0, lines);
  for (std::int64_t seed = 1; seed <= lines; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const double away = log_uniform(random, 1e-9, 4e-4), a = 1 + uniform(random, 1, 0.3)[0];
    const Eigen::Vector3d home = at(a, 150 * kPi / 180);
    const std::string code = refusal({{"scene.home", fmt::format("{{psi1: 0, psi2: {:.17g}, psi3: {:.17g}}}", home[1], home[2])},
                                      {"path.line.from", text(robot.end_effector(home))},
                                      {"path.line.to", text(robot.end_effector(at(a, kPi - away)))}});
    figure.look(code == "singular_path" || code == "crosses_branch" ? 0 : 1,
                [&] { return fmt::format("seed {}, {} rad from flat: '{}'", seed, away, code); });
  }
}

}  // namespace
}  // namespace mixloop::stress
