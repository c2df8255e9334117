// SPDX-License-Identifier: MIT
// M over all poses of the paper's robot.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "dynamics/equations.hpp"
#include "tests/oracles/mixed_loop_robot.hpp"
#include "tests/stress/figure.hpp"
#include "tests/stress/scenes.hpp"

namespace mixloop::stress {
namespace {

/// M from the scene's machine code.
class MassMatrix {
 public:
  explicit MassMatrix(double payload)
      : scene_(papers_robot()),
        dynamics_(equations_of(scene_, Evaluation::machine_code, {Purpose::mass_matrix}),
                  std::array{payload}) {}
  Eigen::Matrix3d at(double a, double b) {
    Eigen::Matrix3d M;
    dynamics_.evaluate(Purpose::mass_matrix, {.psi = papers_motors(a, b)}, {M.data(), 9});
    return M;
  }
  struct Eigenvalues {
    double least, most;
    double condition() const { return least > 0 ? most / least : HUGE_VAL; }
  };
  Eigenvalues eigenvalues(double a, double b) {
    const Eigen::Vector3d values =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(at(a, b), Eigen::EigenvaluesOnly).eigenvalues();
    return {values[0], values[2]};
  }

 private:
  SharedScene scene_;
  Equations::Workspace dynamics_;
};

/// An upper bound of cond(M), from lengths, masses and inertias alone. M = B^T N B with the constant B of the
/// oracle; cond(M) <= cond(B)^2 lambda_max(N) / lambda_min(N).
///   lambda_max(N) <= trace N <= sum_bodies m (rho^2 + |d rho/da|^2 + |d rho/db|^2) + the moments of inertia
///   lambda_min(N) >= the least of J >= I_yy of body 1 and that of the turning links' own inertia,
///     sum I_n s s^T with s = d angle / d(a, b): (1, 0), (1 + r6, -r6), (0, 1), (1, 0), (0, 1)
double condition_bound(double payload) {
  const auto robot = oracle::paper_numbers<double>(payload);
  struct Part {
    oracle::Link<double> link;
    double reach;                 // from the shoulder axis
    std::array<double, 2> moved;  // |d point / d a|, |d point / d b|
    std::array<double, 2> spin;
  };
  const auto size = [](const oracle::Link<double>& link, double length) {
    return std::hypot(length + link.x, link.y);
  };
  const double k = 1 + robot.r6, r = robot.r6;
  oracle::Link<double> load;
  load.mass = payload;
  const double c2 = size(robot.link2, robot.L2), c3 = size(robot.link3, robot.L3),
               c4 = size(robot.link4, robot.L4), c5 = size(robot.link5, robot.L5),
               c6 = size(robot.link6, robot.L4);
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
    trace += part.link.mass *
                 (part.reach * part.reach + part.moved[0] * part.moved[0] + part.moved[1] * part.moved[1]) +
             std::max(part.link.I_along, part.link.I_across) + part.link.I_normal * spin.squaredNorm();
    own += part.link.I_normal * spin * spin.transpose();
  }
  const double least =
      std::min(robot.base_inertia, Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(own).eigenvalues()[0]);
  const Eigen::Vector3d B =
      oracle::MixedLoopRobot<double>(robot).basis_jacobian().jacobiSvd().singularValues();
  return std::pow(B[0] / B[2], 2) * trace / least;
}

struct Pose {
  double a = 0, b = 0, condition = 0;
};

/// Whether the robot can stand so as it is assembled: parallelogram and elbow on home's side, 0 < q4, q5 <
/// 180 deg.
bool on_home_branch(double a, double b) {
  const auto q =
      oracle::MixedLoopRobot<double>(oracle::paper_numbers<double>()).dependent({0, -16 * a, -16 * b});
  return std::sin(q[3]) > 0 && std::sin(q[4]) > 0;
}

/// From a grid's worst pose uphill, with steps that halve.
Pose climb(MassMatrix& M, Pose at, double step) {
  while (step > 1e-9) {
    Pose best = at;
    for (const auto& [da, db] :
         {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}) {
      const double a = at.a + da * step, b = at.b + db * step, condition = M.eigenvalues(a, b).condition();
      if (condition > best.condition) best = {a, b, condition};
    }
    if (best.condition > at.condition)
      at = best;
    else
      step /= 2;
  }
  return at;
}

// M does not depend on q1: the poses are q2 and q3, all of them, also those that the elbow or the
// parallelogram can't take.
void search(const std::string& name, double payload) {
  const std::int64_t grid = length(120, 1200);
  Figure figure(name, "condition number", condition_bound(payload), grid * grid);
  MassMatrix M(payload);
  Pose worst, worst_at_home;
  double least = HUGE_VAL;
  const auto where = [&](double a, double b) {
    return fmt::format("q2 = {:.4f}, q3 = {:.4f} deg", a * 180 / std::numbers::pi,
                       b * 180 / std::numbers::pi);
  };
  for (std::int64_t i = 0; i < grid; ++i)
    for (std::int64_t j = 0; j < grid; ++j) {
      const double a = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(grid),
                   b = 2 * std::numbers::pi * static_cast<double>(j) / static_cast<double>(grid);
      const auto values = M.eigenvalues(a, b);
      least = std::min(least, values.least);
      figure.look(values.condition(), [&] { return where(a, b); });
      if (values.condition() > worst.condition) worst = {a, b, values.condition()};
      if (values.condition() > worst_at_home.condition && on_home_branch(a, b))
        worst_at_home = {a, b, values.condition()};
    }
  worst = climb(M, worst, 2 * std::numbers::pi / static_cast<double>(grid));
  figure.look(worst.condition, [&] { return where(worst.a, worst.b); });
  figure.note(fmt::format("at {}; on home's branch {:.4g} at {}; least eigenvalue {:.4g}",
                          where(worst.a, worst.b), worst_at_home.condition,
                          where(worst_at_home.a, worst_at_home.b), least));
}

TEST(Condition, OfMIsBoundedOverTheWholeWorkspace) { search("condition", 5); }
TEST(ConditionEmpty, OfMIsBoundedOverTheWholeWorkspaceWithoutPayload) { search("condition_empty", 0); }

}  // namespace
}  // namespace mixloop::stress
