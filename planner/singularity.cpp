// SPDX-License-Identifier: MIT
#include "planner/singularity.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "dynamics/procedure/decompositions.hpp"
#include "planner/motion.hpp"

namespace mixloop {
namespace {

/// A value that is this small beside those round about is a zero.
constexpr double kZero = 1e-9;
constexpr double kRoundAbout = 0.1;  // in motor scales
constexpr double kTakesPart = 0.05;  // of a move of the motors, in their scales

/// det A / |adj A| = 1 / |A^-1| in Frobenius norms, for A of up to 3 rows; 0 where A has no inverse.
double small_distance_to_singular(const Matrix& A) {
  if (A.rows() == 1) return A(0, 0);
  if (A.rows() == 2) {
    const double det = A(0, 0) * A(1, 1) - A(0, 1) * A(1, 0), norm = A.norm();
    return norm > 0 ? det / norm : 0;
  }
  const Eigen::Vector3d a = A.col(0), b = A.col(1), c = A.col(2), x = b.cross(c), y = c.cross(a),
                        z = a.cross(b);
  const double norm = std::sqrt(x.squaredNorm() + y.squaredNorm() + z.squaredNorm());
  return norm > 0 ? a.dot(x) / norm : 0;
}

/// The same for any A with no more rows than columns: of a wide one by its pseudoinverse, and without a sign.
double signed_distance_to_singular(const Matrix& A) {
  if (!A.allFinite()) return std::nan("");
  const bool is_square = A.rows() == A.cols();
  if (is_square && A.rows() <= 3) return small_distance_to_singular(A);
  const Vector sigma = singular_values(A).s;
  if (!(sigma[sigma.size() - 1] > 0)) return 0;
  const double distance = 1 / sigma.cwiseInverse().norm();
  return is_square ? std::copysign(distance, Factored(A).determinant()) : distance;
}

}  // namespace

SingularityMeasures::SingularityMeasures(const Model<double>& model, const Vector& motor_scale,
                                         const std::optional<std::vector<int>>& held)
    : model_(model),
      n_u_(model.n_u()),
      ws_(model),
      motor_scale_(motor_scale),
      hand_(model),
      scale_(model.scene->singularities.size() + (held ? 1 : 0), 1.0),
      buffer_(scale_.size()) {
  if (held) prescription_.emplace(hand_, *held);
  const Vector home = Eigen::Map<const Vector>(model.scene->home.data(), n_u_);
  evaluate_raw(home, 0, scale_.data());
  const std::vector<double> about = largest_about(home);
  for (std::size_t i = 0; i < count(); ++i)
    if (!(std::abs(scale_[i]) > kZero * about[i])) scale_[i] = 0;
}

// A named measure may have any unit: what is small is told by its values at poses about this one.
std::vector<double> SingularityMeasures::largest_about(const Vector& psi) {
  std::vector<double> largest(count(), 0.0);
  for (int motor = 0; motor < n_u_; ++motor)
    for (const double away : {-kRoundAbout, kRoundAbout}) {
      Vector near = psi;
      near[motor] += away * motor_scale_[motor];
      evaluate_raw(near, 0, buffer_.data());
      for (std::size_t i = 0; i < count(); ++i)
        if (std::isfinite(buffer_[i])) largest[i] = std::max(largest[i], std::abs(buffer_[i]));
    }
  return largest;
}

std::string SingularityMeasures::name(std::size_t measure) const {
  const auto& singularities = model_.scene->singularities;
  return measure < named() ? "'" + singularities[measure].name + "'" : "of the end effector's Jacobian";
}

void SingularityMeasures::evaluate_raw(const Vector& motors, double t, double* values) {
  const auto& scene = *model_.scene;
  const Symbols symbols(scene);
  const Vector psi = with_free_at_home(scene, {motors, {}, {}}).psi;
  coordinates<double>(model_, span_of(psi), t, ws_);
  const auto symbol = [&](int number) -> double {
    if (symbols.is_q(number)) return ws_.q[number - symbols.q0];
    if (symbols.is_psi(number)) return psi[number - symbols.psi0];
    return number == Symbols::kTime
               ? t
               : model_.parameters[static_cast<std::size_t>(number - Symbols::kParameter0)];
  };
  for (const auto& singularity : scene.singularities)
    *values++ = mixloop::evaluate<double>(singularity.measure, symbol);
  if (prescription_) *values = signed_distance_to_singular(scaled_jacobian(motors, t));
}

Matrix SingularityMeasures::scaled_jacobian(const Vector& motors, double t) {
  return prescription_->jacobian(t, motors) * prescription_->on_active(motor_scale_).asDiagonal();
}

// By the singular vectors of the least singular value.
std::string SingularityMeasures::lost(std::size_t measure, const Vector& psi, double t) {
  if (measure < named()) return {};
  const Matrix J = scaled_jacobian(psi, t);
  if (!J.allFinite()) return {};
  const SingularValues found = singular_values(J);
  const Eigen::Index last = found.s.size() - 1;
  std::string motors;
  if (J.rows() == J.cols()) {
    const Vector idle = prescription_->on_all(found.V.col(last));
    for (Eigen::Index i = 0; i < idle.size(); ++i)
      if (std::abs(idle[i]) > kTakesPart)
        motors += (motors.empty() ? "" : ", ") + model_.scene->motors()[static_cast<std::size_t>(i)].name;
    motors = fmt::format(", whatever {} {}", motors,
                         motors.find(',') == std::string::npos ? "does" : "do together");
  }
  return fmt::format(" ({}{})", prescription_->text_of_lost(t, psi, found.U.col(last)), motors);
}

void SingularityMeasures::evaluate(const Vector& psi, double t, double* values) {
  evaluate_raw(psi, t, values);
  for (std::size_t i = 0; i < count(); ++i) values[i] = scale_[i] == 0 ? 0 : values[i] / scale_[i];
}

bool SingularityMeasures::on_home_branch(const Vector& psi, double t) {
  evaluate_raw(psi, t, buffer_.data());
  for (std::size_t i = 0; i < count(); ++i)
    if (scale_[i] != 0 && !(buffer_[i] * scale_[i] > 0)) return false;
  return true;
}

void SingularityMeasures::adopt_scale(const Vector& psi, double t) {
  evaluate_raw(psi, t, buffer_.data());
  for (std::size_t i = 0; i < count(); ++i)
    if (scale_[i] == 0) scale_[i] = buffer_[i];
}

namespace {

/// One measure along a path, at whole steps and between them.
class Profile {
 public:
  Profile(const std::vector<double>& samples, std::size_t measures, std::size_t which,
          const std::function<void(double, double*)>& at)
      : samples_(samples), measures_(measures), which_(which), at_(at), values_(measures) {}

  std::size_t size() const { return samples_.size() / measures_; }
  double operator[](std::size_t i) const { return samples_[i * measures_ + which_]; }
  double between(double step) {
    at_(step, values_.data());
    return values_[which_];
  }

  /// The first passage by this measure.
  std::optional<Passage> first() {
    if (!((*this)[0] > 0)) return Passage{0, which_, (*this)[0], true};
    for (std::size_t i = 0; i < size(); ++i) {
      if (i > 0 && !((*this)[i] > 0)) return crossing(static_cast<double>(i - 1), static_cast<double>(i));
      if ((*this)[i] < SingularityMeasures::kLeast || may_dip(i)) {
        const Passage nearest = minimum(i);
        if (nearest.value < SingularityMeasures::kLeast) return nearest;
      }
    }
    return std::nullopt;
  }

 private:
  /// A sample below both neighbours, so far down that the measure, as steep beside it as between samples,
  /// could pass the bound between them.
  bool may_dip(std::size_t i) const {
    const double here = (*this)[i];
    const double before = i > 0 ? (*this)[i - 1] : here, after = i + 1 < size() ? (*this)[i + 1] : here;
    return here <= before && here <= after &&
           here - 2 * (std::max(before, after) - here) < SingularityMeasures::kLeast;
  }

  Passage crossing(double positive, double negative) {
    for (int i = 0; i < 60 && positive < negative; ++i) {
      const double middle = (positive + negative) / 2;
      if (middle <= positive || middle >= negative) break;
      (between(middle) > 0 ? positive : negative) = middle;
    }
    return {negative, which_, between(negative), true};
  }

  /// The nearest approach to zero next to sample i (golden section; Kiefer 1953), or a crossing on the way
  /// there.
  Passage minimum(std::size_t i) {
    while (i + 1 < size() && (*this)[i + 1] < (*this)[i] && (*this)[i + 1] > 0) ++i;
    double left = static_cast<double>(i > 0 ? i - 1 : i),
           right = static_cast<double>(std::min(i + 1, size() - 1));
    constexpr double kGolden = 0.6180339887498949;
    double x1 = right - kGolden * (right - left), x2 = left + kGolden * (right - left), f1 = between(x1),
           f2 = between(x2);
    for (int k = 0; k < 50 && f1 > 0 && f2 > 0; ++k) {
      if (f1 < f2) {
        right = x2, x2 = x1, f2 = f1;
        f1 = between(x1 = right - kGolden * (right - left));
      } else {
        left = x1, x1 = x2, f1 = f2;
        f2 = between(x2 = left + kGolden * (right - left));
      }
    }
    if (!(f1 > 0) || !(f2 > 0)) return crossing(left, f1 > 0 ? x2 : x1);
    const bool sampled = (*this)[i] <= std::min(f1, f2);
    return {sampled ? static_cast<double>(i) : (x1 + x2) / 2, which_, sampled ? (*this)[i] : std::min(f1, f2),
            false};
  }

  const std::vector<double>& samples_;
  std::size_t measures_, which_;
  const std::function<void(double, double*)>& at_;
  std::vector<double> values_;
};

}  // namespace

std::optional<Passage> first_passage(const std::vector<double>& samples, std::size_t measures,
                                     const std::function<void(double step, double* values)>& at) {
  std::optional<Passage> first;
  for (std::size_t which = 0; which < measures; ++which) {
    const auto passage = Profile(samples, measures, which, at).first();
    // Of two within a step the one that the scene names, which comes first, says more.
    if (passage && (!first || passage->step < first->step - 1)) first = passage;
  }
  return first;
}

}  // namespace mixloop
