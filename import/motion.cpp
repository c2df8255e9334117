// SPDX-License-Identifier: MIT
#include "import/motion.hpp"

#include <algorithm>
#include <cmath>

#include "dynamics/procedure/procedure.hpp"
#include "planner/cycloid.hpp"

namespace mixloop {
namespace {

constexpr double kSpare = 0.8;  ///< of a limit that a motion takes

/// A scene's numbers at poses, for the parameters' defaults.
class AtPoses {
 public:
  explicit AtPoses(const std::shared_ptr<const Scene>& scene)
      : values_(scene->default_parameters()),
        model_(make_model<double>(scene, std::span<const double>(values_))),
        ws_(model_),
        zero_(static_cast<std::size_t>(scene->n()), 0.0) {}

  Eigen::MatrixXd mass(const std::vector<double>& psi) { return mass_matrix<double>(model_, psi, 0.0, ws_); }
  Eigen::VectorXd torque(const std::vector<double>& psi, const std::vector<double>& psid,
                         const std::vector<double>& psidd) {
    return inverse_dynamics<double>(model_, psi, psid, psidd, 0.0, ws_);
  }
  Eigen::MatrixXd jacobian(const std::vector<double>& psi) {
    return end_effector<double>(model_, psi, zero_, zero_, 0.0, ws_).jacobian;
  }

 private:
  std::vector<double> values_;
  Model<double> model_;
  Workspace<double> ws_;
  std::vector<double> zero_;
};

/// The motors' target, home for the free ones.
std::vector<double> pose_at_target(const Scene& scene, const Motion& motion) {
  std::vector<double> psi = scene.home;
  std::copy(motion.target.begin(), motion.target.end(), psi.begin());
  return psi;
}

/// Half a radian or a tenth of a metre, but what the limit of velocity lets be in 20 s and a quarter of the
/// way to the limit that is farther off.
double moderate_step(const MotorLimits& limits, bool slides, double home) {
  double most = slides ? 0.1 : 0.5;
  if (limits.velocity) most = std::min(most, 10 * kSpare * *limits.velocity);
  if (!limits.position) return most;
  const double up = limits.position->second - home, down = home - limits.position->first;
  return up >= down ? std::min(most, up / 4) : -std::min(most, down / 4);
}

/// The least time in which the cycloid (34) keeps the limits of velocity, in tenths of a second.
double least_duration(const std::vector<MotorLimits>& limits, const Scene& scene, const Motion& motion) {
  double duration = 2;
  for (std::size_t i = 0; i < limits.size(); ++i)
    if (limits[i].velocity)
      duration =
          std::max(duration, 2 * std::abs(motion.target[i] - scene.home[i]) / (kSpare * *limits[i].velocity));
  return std::ceil(duration * 10) / 10;
}

/// The motors whose limit of torque the cycloid to the target doesn't keep.
std::vector<std::size_t> overloaded(AtPoses& at, const Scene& scene, const std::vector<MotorLimits>& limits,
                                    const Motion& motion) {
  constexpr int kSteps = 32;
  const std::vector<double> end = pose_at_target(scene, motion);
  std::vector<double> psi = scene.home, psid(psi.size()), psidd(psi.size());
  Eigen::VectorXd most = Eigen::VectorXd::Zero(scene.n());
  for (int k = 0; k <= kSteps; ++k) {
    for (std::size_t i = 0; i < psi.size(); ++i) {
      const Displacement way =
          cycloid(static_cast<double>(k) / kSteps, end[i] - scene.home[i], motion.duration);
      psi[i] = scene.home[i] + way.s;
      psid[i] = way.sd;
      psidd[i] = way.sdd;
    }
    most = most.cwiseMax(at.torque(psi, psid, psidd).cwiseAbs());
  }
  std::vector<std::size_t> motors;
  for (std::size_t i = 0; i < limits.size(); ++i)
    if (limits[i].torque && most[static_cast<Eigen::Index>(i)] > kSpare * *limits[i].torque)
      motors.push_back(i);
  return motors;
}

/// Of each independent coordinate: the joints' that follow it included.
Eigen::VectorXd damping_of(const Robot& robot, const Roles& roles) {
  std::vector<int> independent = roles.motors;
  independent.insert(independent.end(), roles.free.begin(), roles.free.end());
  Eigen::VectorXd damping = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(independent.size()));
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    if (!robot.joints[j].moves()) continue;
    const Following follows = following(robot, static_cast<int>(j));
    const auto at = std::find(independent.begin(), independent.end(), follows.joint) - independent.begin();
    damping[at] += robot.joints[j].damping * follows.slope * follows.slope;
  }
  return damping;
}

}  // namespace

Motion moderate_motion(const std::shared_ptr<const Scene>& scene, const Robot& robot, const Roles& roles,
                       const std::vector<MotorLimits>& limits) {
  AtPoses at(scene);
  const auto motion_of = [&](double share) {
    Motion motion;
    for (std::size_t i = 0; i < limits.size(); ++i) {
      const bool slides = robot.joints[static_cast<std::size_t>(roles.motors[i])].slides();
      const double step = share * moderate_step(limits[i], slides, scene->home[i]);
      motion.target.push_back(scene->home[i] +
                              (std::abs(step) < 0.01 ? step : std::trunc(step * 1000) / 1000));
    }
    motion.duration = least_duration(limits, *scene, motion);
    return motion;
  };
  for (const double share : {1.0, 0.5, 0.25, 0.125}) {
    Motion motion = motion_of(share);
    for (int slower = 0; slower < 3; ++slower, motion.duration *= 2)
      if (overloaded(at, *scene, limits, motion).empty()) return motion;
  }
  Motion motion = motion_of(1);
  motion.overloaded = overloaded(at, *scene, limits, motion);
  return motion;
}

Tuning moderate_tuning(const std::shared_ptr<const Scene>& scene, const Robot& robot, const Roles& roles,
                       const Motion& motion) {
  // With D = diag(1 / (M^-1)_ii) no eigenvalue of M^-1 D exceeds n: of s^2 + 2 w lambda s + w^2 lambda no
  // root is faster than 2 w n, which is kept below 400 1/s.
  AtPoses at(scene);
  const int n = scene->n_u();
  const double w = std::min(20.0, 200.0 / n);
  const Eigen::VectorXd damping = damping_of(robot, roles);
  Eigen::VectorXd felt = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity());
  double fastest = 0;  // no eigenvalue of M^-1 diag(damping) exceeds its trace
  for (const auto& psi : {scene->home, pose_at_target(*scene, motion)}) {
    const Eigen::MatrixXd M = at.mass(psi);
    felt = felt.cwiseMin(M.topLeftCorner(n, n).inverse().diagonal().cwiseInverse());
    fastest = std::max(fastest, M.inverse().diagonal().dot(damping));
  }
  Tuning tuning;
  for (const double inertia : felt) {
    tuning.kp.push_back(w * w * inertia);
    tuning.kv.push_back(2 * w * inertia);
  }
  constexpr double kTick = 1e-3, kStable = 2.5;  // rk4 keeps a pole p with |p| h below 2.79
  if (!felt.allFinite() || !std::isfinite(fastest))
    throw InputError(
        "not_finite", {},
        "masses, moments and lengths are so unlike that the mass matrix has no finite inverse at home");
  tuning.substeps = std::max(1, static_cast<int>(std::ceil(std::min(fastest * kTick / kStable, 1000.0))));
  tuning.lags = fastest * kTick > 0.5;
  return tuning;
}

std::string free_axes(const std::shared_ptr<const Scene>& scene, const Motion& motion) {
  // The rows of the Jacobian at home, half-way and at the target that are independent of those taken before.
  AtPoses at(scene);
  const std::vector<double> end = pose_at_target(*scene, motion);
  const int n = scene->n_u();
  Eigen::MatrixXd rows(3, 3 * n);
  for (int k = 0; k < 3; ++k) {
    std::vector<double> psi = scene->home;
    for (std::size_t i = 0; i < psi.size(); ++i) psi[i] += 0.5 * k * (end[i] - scene->home[i]);
    rows.middleCols(k * n, n) = at.jacobian(psi).leftCols(n);
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(rows.transpose());
  const double largest = std::abs(qr.matrixQR()(0, 0));
  std::string axes;
  for (int i = 0; i < std::min(3, n); ++i)
    if (std::abs(qr.matrixQR()(i, i)) > 1e-6 * largest) axes += "xyz"[qr.colsPermutation().indices()[i]];
  std::sort(axes.begin(), axes.end());
  return axes;
}

}  // namespace mixloop
