// SPDX-License-Identifier: MIT
#include "planner/inverse_kinematics.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <optional>

#include "dynamics/procedure/decompositions.hpp"

namespace mixloop {
namespace {

constexpr int kMostIterations = 100;
constexpr int kStartsFromHome = 400;
constexpr double kFarthestStart = 4;  // in motor scales: about a half turn of a joint and more

constexpr double kRoundOff = std::numeric_limits<double>::epsilon();
constexpr double kStraight = 1e-3;  // of a way: how far the end effector may be off it

/// A system of up to three equations, filled up by x_i = 0 to three, which Eigen unrolls.
bool is_small(const Matrix& A) { return A.rows() == A.cols() && A.rows() <= 3; }
Eigen::Matrix3d filled(const Matrix& A) {
  Eigen::Matrix3d three = Eigen::Matrix3d::Identity();
  three.topLeftCorner(A.rows(), A.cols()) = A;
  return three;
}
Eigen::Vector3d filled(const Vector& x, double rest) {
  Eigen::Vector3d three = Eigen::Vector3d::Constant(rest);
  three.head(x.size()) = x;
  return three;
}

class SquareSolution {
 public:
  explicit SquareSolution(const Matrix& A) : size_(A.rows()) {
    if (is_small(A))
      small_.compute(filled(A));
    else
      large_.emplace(A);
  }
  Vector solve(const Vector& b) const {
    if (large_) return large_->solve(b);
    const Eigen::Vector3d x = small_.solve(filled(b, 0));
    return x.head(size_);
  }

 private:
  Eigen::Index size_;
  Eigen::PartialPivLU<Eigen::Matrix3d> small_;
  std::optional<Factored> large_;
};

/// The x with J x = b: of a square J by its LU; of a wide one the least x in units of `scale`.
class LeastSolution {
 public:
  LeastSolution(const Matrix& J, const Vector& scale)
      : J_(J),
        weighted_(is_square() ? Matrix() : Matrix(scale.cwiseAbs2().asDiagonal() * J.transpose())),
        square_(is_square() ? J : product(J, weighted_)) {}

  bool is_square() const { return J_.rows() == J_.cols(); }
  Vector solve(const Vector& b) const {
    return is_square() ? square_.solve(b) : Vector(weighted_ * square_.solve(b));
  }
  /// Of a wide J: with x = scale^2 J^T lambda.
  Vector multipliers(const Vector& b) const { return square_.solve(b); }
  /// Of a wide J: what a change of J^T lambda by `turned` changes of x, J x unchanged.
  Vector across(const Vector& turned, const Vector& scale) const {
    const Vector x = scale.cwiseAbs2().cwiseProduct(turned);
    return x - solve(J_ * x);
  }

 private:
  Matrix J_, weighted_;
  SquareSolution square_;
};

Vector solution(const Matrix& A, const Vector& b) { return Factored(A).solve(b); }
Eigen::Vector3d solution(const Eigen::Matrix3d& A, const Eigen::Vector3d& b) {
  return A.partialPivLu().solve(b);
}

/// Marquardt's step (J^T J + damping diag(J^T J)) x = J^T error (SIAM J. 11, 1963), worked out in units of
/// `scale`. Of the unknowns the first `count` are some.
template <class Square, class Column>
Column marquardt_step(const Square& J, const Column& error, double damping, const Column& scale,
                      Eigen::Index count) {
  const Square scaled = J * scale.asDiagonal();
  Square A = scaled.transpose().lazyProduct(scaled);
  const double least = 1e-12 * A.diagonal().head(count).maxCoeff();
  for (Eigen::Index i = 0; i < A.rows(); ++i) A(i, i) += damping * std::max(A(i, i), least);
  return scale.cwiseProduct(solution(A, scaled.transpose() * error));
}

/// Marquardt's step; undamped, Newton's.
Vector damped_step(const Matrix& J, const Vector& error, double damping, const Vector& scale) {
  if (damping == 0) return LeastSolution(J, scale).solve(error);
  if (!is_small(J)) return marquardt_step<Matrix, Vector>(J, error, damping, scale, scale.size());
  return marquardt_step<Eigen::Matrix3d, Eigen::Vector3d>(filled(J), filled(error, 0), damping,
                                                          filled(scale, 1), scale.size())
      .head(scale.size());
}

/// The angle that differs from `angle` by whole turns and is nearest to `other`.
double unwrapped(double angle, double other) {
  constexpr double turn = 2 * std::numbers::pi;
  return angle + turn * std::round((other - angle) / turn);
}

void require_enough(const Scene& scene, const Prescription& prescription,
                    const InverseKinematics::Redundancy& redundancy) {
  const Eigen::Index rows = prescription.rows(), active = prescription.active();
  if (active == rows || (active > rows && redundancy.least_norm)) return;
  std::string motors = fmt::format("{} motor{}", scene.n_u(), scene.n_u() == 1 ? "" : "s");
  if (!redundancy.held.empty()) motors += fmt::format(", {} of them held", redundancy.held.size());
  const std::string what = fmt::format("the path prescribes {}, and the scene '{}' has {}",
                                       prescription.text(), scene.name, motors);
  const Place place{scene.transforms.front().place.file};
  if (active < rows)
    throw InputError(
        "no_inverse", place,
        fmt::format("{}: too few, by {}; expected as many motors as numbers: fewer end_effector axes, "
                    "or a path of the motors",
                    what, rows - active));
  throw InputError(
      "no_inverse", place,
      fmt::format("{}: {} more than it says how to move; expected `hold: [...]` with {} in the path, "
                  "or `redundancy: least_norm`, or more end_effector axes",
                  what, active - rows, active - rows == 1 ? "a motor" : "so many"));
}

}  // namespace

InverseKinematics::InverseKinematics(const Model<double>& model, Method method, const Redundancy& redundancy)
    : hand_(model), prescription_(hand_, redundancy.held) {
  require_enough(*model.scene, prescription_, redundancy);
  const bool may_be_arm = redundancy.held.empty() && !model.scene->end_effector.is_oriented();
  if (method == Method::closed_form_if_known && may_be_arm) arm_ = find_three_axis_arm(model);
}

// By the motors' angles at home: what a search winds up beyond them resolves nothing.
double InverseKinematics::resolution(const PathPoint& point) const {
  double squared = 0;
  for (const int axis : hand_.model().scene->end_effector.axes)
    squared += point.position[axis] * point.position[axis];
  const double turned = hand_.model().scene->end_effector.is_oriented() ? hand_.scale() : 0;
  return 4 * kRoundOff *
         (std::sqrt(squared) + turned +
          hand_.scale() * hand_.home().cwiseQuotient(hand_.motor_scale()).cwiseAbs().sum());
}

IkOutcome InverseKinematics::closed_form(const Eigen::Vector3d& point, Vector& psi) const {
  const ArmReach reach = reach_of(*arm_, point);
  if (!(reach.beside >= 0 && reach.distance >= arm_->nearest() && reach.distance <= arm_->farthest()))
    return IkOutcome::out_of_reach;
  const auto angles = arm_angles<double>(*arm_, {point[0], point[1], point[2]});
  const Eigen::Vector3d before = arm_->angles(psi);
  psi = arm_->motors(
      {unwrapped(angles[0], before[0]), unwrapped(angles[1], before[1]), unwrapped(angles[2], before[2])});
  return psi.allFinite() ? IkOutcome::solved : IkOutcome::singular;
}

// The closed form on Taylor series in time: its rates are exact.
IkOutcome InverseKinematics::closed_form_rates(const PathPoint& point, Vector& psid, Vector& psidd) const {
  using Series = Taylor<double>;
  const auto along = [&](int i) {
    return Series(point.position[i], point.velocity[i], point.acceleration[i]);
  };
  const auto [base, shoulder, elbow] = arm_angles<Series>(*arm_, {along(0), along(1), along(2)});
  psid = arm_->B_inverse * Eigen::Vector3d(base.d, shoulder.d, elbow.d);
  psidd = arm_->B_inverse * Eigen::Vector3d(base.dd, shoulder.dd, elbow.dd);
  return psid.allFinite() && psidd.allFinite() ? IkOutcome::solved : IkOutcome::singular;
}

// A fine drive and a long slide have far to go, and where the end effector follows the step all along,
// nothing winds up.
bool InverseKinematics::leads_straight(const PathPoint& point, double t, const Vector& psi,
                                       const Vector& step, const Vector& error) {
  for (const double part : {0.25, 0.5, 1.0}) {
    const Vector left = prescription_.miss(point, t, psi + part * step).error;
    if (!((left - (1 - part) * error).norm() <= kStraight * error.norm())) return false;
  }
  return true;
}

IkOutcome InverseKinematics::position(const PathPoint& point, double t, Vector& psi) {
  if (arm_) return closed_form(point.position, psi);
  double damping = 0;
  const Vector active_scale = this->active_scale();
  Prescription::Miss miss = prescription_.miss(point, t, psi);
  // Closures are followed all the way, and close no farther in a straight line than about a turn.
  const double farthest = hand_.model().scene->is_closed() ? 2 * kFarthestStart : HUGE_VAL;
  for (int i = 0; i < kMostIterations; ++i) {
    const Vector step = prescription_.on_all(damped_step(miss.jacobian, miss.error, damping, active_scale));
    const Vector trial = psi + step;
    // Longer steps would wind the motors up.
    const double length = step.cwiseQuotient(hand_.motor_scale()).norm();
    const bool sound =
        step.allFinite() &&
        (length <= 0.5 || (length <= farthest && leads_straight(point, t, psi, step, miss.error)));
    const double distance = miss.error.norm();
    // What Newton's method still has to go is quadratically small in the step (next to a singular pose a
    // small distance may take a long one): this step ends it.
    if (sound && damping == 0 && distance <= std::max(1e-10 * scale(), resolution(point)) &&
        length <= 1e-8 + kRoundOff * psi.cwiseQuotient(hand_.motor_scale()).norm()) {
      psi = trial;
      return IkOutcome::solved;
    }
    Prescription::Miss next;
    if (sound) next = prescription_.miss(point, t, trial);
    if (sound && next.error.norm() < distance) {
      psi = trial;
      miss = std::move(next);
      damping = damping < 1e-6 ? 0 : damping / 10;
    } else {
      damping = damping == 0 ? 1e-6 : damping * 10;
      if (damping > 1e12) break;
    }
  }
  return miss.error.norm() <= std::max(1e-12 * scale(), resolution(point)) ? IkOutcome::solved
                                                                           : IkOutcome::out_of_reach;
}

IkOutcome InverseKinematics::position_from_home(const PathPoint& point, double t, Vector& psi,
                                                const Accepts& accepts) {
  const Vector& home = hand_.home();
  const Vector& motor_scale = hand_.motor_scale();
  psi = home;
  if (arm_) return closed_form(point.position, psi);
  // A redundant mechanism goes round its singular poses, and has no sides.
  const auto side = [&](const Vector& at) {
    return is_redundant() ? 1 : Factored(prescription_.miss(point, t, at).jacobian).determinant();
  };
  const double home_side = side(home);
  const auto on_home_side = [&](const Vector& at) {
    return home_side * side(at) >= 0 && (!accepts || accepts(at));
  };
  bool found_other = false;
  double nearest = HUGE_VAL, least_miss = HUGE_VAL;
  for (int start = 0; start <= kStartsFromHome; ++start) {
    // Spread evenly about home (a Kronecker sequence), farther and farther away.
    const double spread = kFarthestStart * start / kStartsFromHome;
    if (nearest <= spread) break;
    Vector away(home.size());
    for (Eigen::Index i = 0; i < away.size(); ++i)
      away[i] = spread * motor_scale[i] *
                (2 * std::fmod(0.5 + start * std::sqrt(static_cast<double>(2 + 3 * i)), 1.0) - 1);
    Vector found = home + prescription_.on_all(prescription_.on_active(away));
    if (start > 0 && !on_home_side(found)) continue;
    if (position(point, t, found) != IkOutcome::solved) {
      const double missed = miss(point, t, found);
      if (nearest == HUGE_VAL && !found_other && missed < least_miss) psi = found;
      least_miss = std::min(least_miss, missed);
    } else if (!on_home_side(found)) {
      found_other = true;
    } else if (const double distance = (found - home).cwiseQuotient(motor_scale).norm(); distance < nearest) {
      nearest = distance;
      psi = found;
    }
  }
  if (nearest < HUGE_VAL) return IkOutcome::solved;
  return found_other ? IkOutcome::other_branch : IkOutcome::out_of_reach;
}

IkOutcome InverseKinematics::velocity(const PathPoint& point, double t, const Vector& psi, Vector& psid) {
  Vector psidd;
  if (arm_) return closed_form_rates(point, psid, psidd);
  const Prescription::Miss now = prescription_.miss(point, t, psi);
  psid = prescription_.on_all(LeastSolution(now.jacobian, active_scale()).solve(now.rate));
  return psid.allFinite() ? IkOutcome::solved : IkOutcome::singular;
}

IkOutcome InverseKinematics::rates(const PathPoint& point, double t, const Vector& psi, Vector& psid,
                                   Vector& psidd) {
  if (arm_) return closed_form_rates(point, psid, psidd);
  const Vector scale = active_scale();
  const Prescription::Miss now = prescription_.miss(point, t, psi);
  const LeastSolution J(now.jacobian, scale);
  psid = prescription_.on_all(J.solve(now.rate));
  if (!psid.allFinite()) return IkOutcome::singular;
  Vector moved = J.solve(prescription_.acceleration_to(point, t, psi, psid));
  // d/dt (scale^2 J^T lambda): the least acceleration, and along the motors' freedom the rate of the least
  // velocity.
  if (!J.is_square())
    moved += J.across(prescription_.turning_back(point, t, psi, psid, J.multipliers(now.rate)), scale);
  psidd = prescription_.on_all(moved);
  return psidd.allFinite() ? IkOutcome::solved : IkOutcome::singular;
}

}  // namespace mixloop
