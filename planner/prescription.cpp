// SPDX-License-Identifier: MIT
#include "planner/prescription.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "planner/orientation.hpp"

namespace mixloop {
namespace {

constexpr double kNoTurn = 1e-9;      // of a turn: rounding
constexpr int kLookedAt = 5;          // poses about home
constexpr double kTurnedAbout = 0.3;  // in motor scales

}  // namespace

Prescription::Prescription(HandKinematics& hand, const std::vector<int>& held)
    : hand_(hand), end_effector_(hand.model().scene->end_effector) {
  for (int i = 0; i < hand.model().n_u(); ++i)
    if (std::ranges::count(held, i) == 0) active_.push_back(i);
  turning_ = end_effector_.direction ? 2 : static_cast<Eigen::Index>(end_effector_.turns.size());
  rows_ = static_cast<Eigen::Index>(end_effector_.axes.size()) + turning_;
  if (end_effector_.turns.size() == 1) require_turns_about(end_effector_.turns.front());
}

// A turn about one axis says how a frame is turned only where it turns about no other.
void Prescription::require_turns_about(int axis) {
  for (int look = 0; look < kLookedAt; ++look) {
    Vector psi = hand_.home();
    for (Eigen::Index i = 0; i < psi.size(); ++i)
      psi[i] += kTurnedAbout * hand_.motor_scale()[i] * std::sin(static_cast<double>(look * (2 * i + 3)));
    const auto J = hand_.turns_at(psi, hand_.rest(), hand_.rest(), 0).jacobian;
    if (!J.allFinite()) continue;  // closures end on the way there
    for (int other = 0; other < 3; ++other)
      if (other != axis && J.row(other).norm() > kNoTurn * J.norm())
        throw InputError(
            "other_turns", hand_.model().scene->transforms.front().place,
            fmt::format("the end effector's axes name its turn about {} alone, and it turns about {} "
                        "too; expected rx, ry, rz, or its 'direction'",
                        "xyz"[axis], "xyz"[other]));
  }
}

std::string Prescription::text() const {
  std::string names;
  const auto add = [&](const std::string& name) { names += (names.empty() ? "" : ", ") + name; };
  for (const int axis : end_effector_.axes) add(std::string(1, "xyz"[axis]));
  for (const int axis : end_effector_.turns) add(fmt::format("r{}", "xyz"[axis]));
  if (end_effector_.direction) add("the two of its direction");
  return fmt::format("{} number{} of the end effector ({})", rows_, rows_ == 1 ? "" : "s", names);
}

Vector Prescription::on_all(const Vector& active) const {
  Vector all = Vector::Zero(hand_.model().n_u());
  for (std::size_t i = 0; i < active_.size(); ++i) all[active_[i]] = active[static_cast<Eigen::Index>(i)];
  return all;
}

Vector Prescription::on_active(const Vector& all) const {
  Vector active(this->active());
  for (std::size_t i = 0; i < active_.size(); ++i) active[static_cast<Eigen::Index>(i)] = all[active_[i]];
  return active;
}

// Of a vector about which the frame turns, what counts, as a length: turning_ x 3.
Matrix Prescription::turning_rows(const Eigen::Matrix3d& rotation) const {
  Matrix rows = Matrix::Zero(turning_, 3);
  if (end_effector_.direction) {
    const Eigen::Vector3d d = rotation * axis_of(end_effector_), u = d.unitOrthogonal();
    rows.row(0) = u.transpose();
    rows.row(1) = d.cross(u).transpose();
  } else {
    for (Eigen::Index i = 0; i < turning_; ++i) rows(i, end_effector_.turns[static_cast<std::size_t>(i)]) = 1;
  }
  return hand_.scale() * rows;
}

Prescription::Miss Prescription::miss(const PathPoint& point, double t, const Vector& psi) {
  Miss out{Vector(rows_), Matrix(rows_, active()), Vector(rows_), 0, 0};
  const auto fill = [&](Eigen::Index row, auto values, double error, double rate) {
    out.error[row] = error;
    out.rate[row] = rate;
    for (std::size_t j = 0; j < active_.size(); ++j)
      out.jacobian(row, static_cast<Eigen::Index>(j)) = values[active_[j]];
  };
  const auto& state = hand_.at(psi, hand_.rest(), hand_.rest(), t);
  if (turning_ > 0) {
    const HandTurns turns = hand_.turns();
    const Matrix rows = turning_rows(point.rotation), J = rows * turns.jacobian;
    Eigen::Matrix3d turn = point.rotation * turns.rotation.transpose();
    if (end_effector_.direction) {
      const Eigen::Vector3d axis = axis_of(end_effector_);
      turn = shortest_turn(turns.rotation * axis, point.rotation * axis);
    }
    const Eigen::Vector3d missing = rotation_vector(turn);
    const Vector error = rows * missing, rate = rows * (point.spin - turns.spin);
    out.angle = error.norm() / hand_.scale();
    for (Eigen::Index i = 0; i < turning_; ++i) fill(rows_ - turning_ + i, J.row(i), error[i], rate[i]);
  }
  Eigen::Index row = 0;
  for (const int axis : end_effector_.axes) {
    fill(row, state.jacobian.row(axis), point.position[axis] - state.position[axis],
         point.velocity[axis] - state.velocity[axis]);
    ++row;
  }
  out.place = out.error.head(row).norm();
  return out;
}

Matrix Prescription::jacobian(double t, const Vector& psi) {
  PathPoint here;
  if (turning_ > 0) here.rotation = hand_.turns_at(psi, hand_.rest(), hand_.rest(), t).rotation;
  return miss(here, t, psi).jacobian;
}

std::string Prescription::text_of_lost(double t, const Vector& psi, const Vector& move) {
  Eigen::Vector3d place = Eigen::Vector3d::Zero(), turn = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < end_effector_.axes.size(); ++i)
    place[end_effector_.axes[i]] = move[static_cast<Eigen::Index>(i)];
  if (turning_ > 0) {
    const Eigen::Matrix3d rotation = hand_.turns_at(psi, hand_.rest(), hand_.rest(), t).rotation;
    turn = turning_rows(rotation).transpose() * move.tail(turning_) / hand_.scale();
  }
  const bool moves = place.norm() >= turn.norm();
  Eigen::Vector3d along = (moves ? place : turn).normalized();
  Eigen::Index most;
  along.cwiseAbs().maxCoeff(&most);
  if (along[most] < 0) along = -along;
  for (double& part : along) part = std::round(part * 1000) / 1000 + 0.0;
  return fmt::format("it can't {} ({:g}, {:g}, {:g})", moves ? "move along" : "turn about", along[0],
                     along[1], along[2]);
}

// A direction d accelerates by alpha x d + omega x (omega x d): beside what is across d in alpha, the spin
// about d, which is free, counts.
Vector Prescription::acceleration_to(const PathPoint& point, double t, const Vector& psi,
                                     const Vector& psid) {
  Vector out(rows_);
  const auto& state = hand_.at(psi, psid, hand_.rest(), t);
  if (turning_ > 0) {
    const HandTurns turns = hand_.turns();
    Eigen::Vector3d missing = point.spin_rate - turns.spin_rate;
    if (end_effector_.direction) {
      const Eigen::Vector3d d = point.rotation * axis_of(end_effector_);
      missing += (point.spin - turns.spin).dot(d) * d.cross(point.spin);
    }
    out.tail(turning_) = turning_rows(point.rotation) * missing;
  }
  Eigen::Index row = 0;
  for (const int axis : end_effector_.axes) out[row++] = point.acceleration[axis] - state.acceleration[axis];
  return out;
}

// Accelerations at psidd = 0 are quadratic in psid: half their slope by psid_j is column j of the Jacobian's
// rate, and exact as a difference; of a turn it is the part that is symmetric in the motors, and the rest of
// it is half the product of the angular velocities (d_k w_j - d_j w_k = w_k x w_j).
Vector Prescription::turning_back(const PathPoint& point, double t, const Vector& psi, const Vector& psid,
                                  const Vector& lambda) {
  Eigen::Vector3d on_place = Eigen::Vector3d::Zero(), on_turn = Eigen::Vector3d::Zero(), on_columns = on_turn;
  for (std::size_t i = 0; i < end_effector_.axes.size(); ++i)
    on_place[end_effector_.axes[i]] = lambda[static_cast<Eigen::Index>(i)];
  HandTurns turns;
  if (turning_ > 0) {
    turns = hand_.turns_at(psi, psid, hand_.rest(), t);
    on_turn = turning_rows(point.rotation).transpose() * lambda.tail(turning_);
    on_columns = on_turn.cross(turns.spin) / 2;
    if (end_effector_.direction) on_columns += point.spin.cross(on_turn);
  }
  Vector out(active());
  for (Eigen::Index j = 0; j < active(); ++j) {
    const int motor = active_[static_cast<std::size_t>(j)];
    const double away = hand_.motor_scale()[motor];
    double slope = 0;
    for (const double side : {1.0, -1.0}) {
      Vector rates = psid;
      rates[motor] += side * away;
      const auto& state = hand_.at(psi, rates, hand_.rest(), t);
      if (turning_ > 0) slope += side * on_turn.dot(hand_.turns().spin_rate);
      slope += side * on_place.dot(state.acceleration);
    }
    out[j] = slope / (4 * away);
    if (turning_ > 0) out[j] += on_columns.dot(turns.jacobian.col(motor));
  }
  return out;
}

}  // namespace mixloop
