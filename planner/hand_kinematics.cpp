// SPDX-License-Identifier: MIT
#include "planner/hand_kinematics.hpp"

#include <cmath>
#include <limits>

#include "notation/long_work.hpp"

namespace mixloop {
namespace {

constexpr double kNothing =
    1e3 * std::numeric_limits<double>::epsilon();  // of what a sum consists of: a sum of nothing

/// Of the transforms from the ground to the end effector, and the point in its frame; 0 where all of it
/// varies.
double length_of_chain(const Model<double>& model) {
  double length = model.end_effector_point.norm();
  for (int frame = model.scene->end_effector.frame; frame != 0;) {
    const auto& link = model.links[static_cast<std::size_t>(frame - 1)];
    length += std::abs(link.a) + std::abs(link.s);
    frame = link.parent;
  }
  return length;
}

}  // namespace

HandKinematics::HandKinematics(const Model<double>& model)
    : model_(model),
      ws_(model),
      home_(Eigen::Map<const Vector>(model.scene->home.data(), model.n_u())),
      rest_(Vector::Zero(model.n_u())),
      motor_scale_(model.n_u()),
      scale_(length_of_chain(model)) {
  const Vector moved = moved_at_home();
  if (!(scale_ > 0)) scale_ = moved.size() > 0 && moved.maxCoeff() > 0 ? moved.maxCoeff() : 1;
  for (Eigen::Index i = 0; i < moved.size(); ++i) {
    const bool linear = model.scene->motors()[static_cast<std::size_t>(i)].linear;
    motor_scale_[i] = moved[i] > 0 ? scale_ / moved[i] : (linear ? scale_ : 1);
  }
}

// A column of the Jacobian is nothing where it is the rounding of the joints' shares that it is summed up
// from: so however fine a drive is, and whatever its units.
Vector HandKinematics::moved_at_home() {
  const Scene& scene = *model_.scene;
  const Eigen::Index n_u = home_.size();
  const bool is_oriented = scene.end_effector.is_oriented();
  const auto rows = static_cast<Eigen::Index>(scene.end_effector.axes.size());
  const auto& state = at(home_, rest_, rest_, 0);
  Matrix J(3, n_u);
  for (Eigen::Index i = 0; i < rows; ++i)
    J.row(i) = state.jacobian.row(scene.end_effector.axes[static_cast<std::size_t>(i)]).head(n_u);
  const HandTurns turns = is_oriented ? this->turns() : HandTurns();
  const PsiMotion home = with_free_at_home(scene, {home_, {}, {}});
  coordinates<double>(model_, span_of(home.psi), 0.0, ws_);
  Vector moved(n_u), shares = Vector::Zero(n_u);
  for (int frame = scene.end_effector.frame; frame != 0;) {
    const auto& link = model_.links[static_cast<std::size_t>(frame - 1)];
    frame = link.parent;
    if (link.coordinate < 0) continue;
    const double arm = std::abs(link.scale) * (link.prismatic ? 1 : scale_);
    shares += arm * ws_.C.row(link.coordinate).head(n_u).cwiseAbs().transpose();
  }
  for (Eigen::Index i = 0; i < n_u; ++i) {
    moved[i] = J.col(i).head(rows).norm();
    if (is_oriented) moved[i] = std::hypot(moved[i], scale_ * turns.jacobian.col(i).norm());
    if (!(moved[i] > kNothing * shares[i])) moved[i] = 0;
  }
  return moved;
}

const EndEffectorState<double>& HandKinematics::at(const Vector& psi, const Vector& psid, const Vector& psidd,
                                                   double t) {
  work_goes_on();  // of a large scene one takes long, and refusals take thousands
  psidd_ = psidd;
  const PsiMotion all = with_free_at_home(*model_.scene, {psi, psid, psidd});
  return end_effector<double>(model_, span_of(all.psi), span_of(all.psid), span_of(all.psidd), t, ws_);
}

// (10), (18), (20), in the frame's axes, turned into the inertial ones.
HandTurns HandKinematics::turns() {
  const int index = model_.scene->end_effector.frame;
  const auto& frame = ws_.frames[static_cast<std::size_t>(index)];
  const auto& path = model_.path(index);
  const Eigen::Index n_u = home_.size();
  angular_variations<double>(frame, ws_.O);
  HandTurns out;
  out.rotation = frame.T_0.leftCols<3>();
  out.jacobian.setZero(3, n_u);
  Eigen::Vector3d spin = Eigen::Vector3d::Zero(), rate = Eigen::Vector3d::Zero();
  for (std::size_t j = 0; j < path.size(); ++j) {
    const auto column = ws_.O.col(static_cast<Eigen::Index>(j));
    spin += column * ws_.qd[path[j]];
    rate += column * ws_.q_bias[path[j]];
    out.jacobian += column * ws_.C.row(path[j]).head(n_u);
  }
  rate += out.jacobian * psidd_;
  const Eigen::Matrix3d skew = detail::skew_of_vector<double>(spin);
  rate +=
      detail::vector_of_skew<double>(out.rotation.transpose() * frame.Tdd_bias.leftCols<3>() - skew * skew);
  out.spin = out.rotation * spin;
  out.spin_rate = out.rotation * rate;
  out.jacobian = (out.rotation * out.jacobian).eval();
  return out;
}

}  // namespace mixloop
