// SPDX-License-Identifier: MIT
// The paper's robot in closed form, by Lagrange. Shares no code and no route with dynamics/.
//
// The base turns the arm's vertical plane by q1 about Z0. In that plane, with
// e(phi) = (cos phi, sin phi) from the radial direction towards Z0, every link stands at an absolute angle:
//   link 2: a = q2                      link 3: c = q2 + q5 = (1 + r6) a - r6 b + k
//   link 4: b = q3                      link 5: q3 + q6 = a - beta
//   link 6: q3 + q6 + q4 = b + pi       k = q5_o - r6 (pi + beta - gamma_o)
// A body of mass m whose centre is at (rho, zeta) over the shoulder, its x axis at phi:
//   T = 1/2 m (rho^2 q1'^2 + rho'^2 + zeta'^2) + 1/2 (I_x sin^2 phi + I_up cos^2 phi) q1'^2 + 1/2 I_n phi'^2
//   V = m g (L1 + zeta)
// The plane's motion does not depend on q1, nor does T on q1 itself, so in the rates (q1', a', b')
//   T = 1/2 J(a, b) q1'^2 + 1/2 (a', b') N(a, b) (a', b')^T.
#pragma once

#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Core>

#include "tests/oracles/robot_numbers.hpp"

namespace mixloop::oracle {

template <class T>
class MixedLoopRobot {
 public:
  using Vector3 = Eigen::Matrix<T, 3, 1>;
  using Matrix3 = Eigen::Matrix<T, 3, 3>;

  struct Energy {
    T kinetic, potential;  ///< potential zero at Z0 = 0
  };

  explicit MixedLoopRobot(RobotNumbers<T> numbers) : n_(std::move(numbers)) {}

  /// The dependent coordinates q1 to q6, (B-1) to (B-6) with (B-2) divided by r3.
  std::array<T, 6> dependent(const Vector3& psi) const {
    const Vector3 q = basis(psi);
    const T q4 = pi<T>() - q[1] + n_.beta + q[2];
    return {q[0], q[1], q[2], q4, n_.q5_o - n_.r6 * (q4 - n_.gamma_o), q[1] - n_.beta - q[2]};
  }

  /// d(q1, a, b) / d psi, constant.
  Matrix3 basis_jacobian() const {
    const T up2 = (1 + 1 / n_.r2) / n_.r1, up3 = (1 + 1 / n_.r4) / n_.r1;
    Matrix3 B = Matrix3::Zero();
    B(0, 0) = 1 / n_.r1;
    B(1, 0) = up2 / n_.r3;
    B(1, 1) = -1 / (n_.r2 * n_.r3);
    B(2, 0) = up3 / n_.r5;
    B(2, 2) = -1 / (n_.r4 * n_.r5);
    return B;
  }

  Matrix3 mass_matrix(const Vector3& psi) const {
    const Matrix3 B = basis_jacobian();
    return B.transpose() * in_basis(psi, Vector3::Zero()).M * B;
  }

  /// h with M psidd + h = tau: Coriolis, centrifugal and gravity.
  Vector3 bias(const Vector3& psi, const Vector3& psid) const {
    return basis_jacobian().transpose() * in_basis(psi, psid).h;
  }

  Vector3 inverse_dynamics(const Vector3& psi, const Vector3& psid, const Vector3& psidd) const {
    const Matrix3 B = basis_jacobian();
    const Lagrange terms = in_basis(psi, psid);
    return B.transpose() * (terms.M * (B * psidd) + terms.h);
  }

  /// psidd under motor torques tau; the block diagonal M solved by hand.
  Vector3 forward_dynamics(const Vector3& psi, const Vector3& psid, const Vector3& tau) const {
    const Lagrange terms = in_basis(psi, psid);
    const Vector3 force = to_basis_force(tau) - terms.h;
    const T& Naa = terms.M(1, 1);
    const T& Nab = terms.M(1, 2);
    const T& Nbb = terms.M(2, 2);
    const T determinant = Naa * Nbb - Nab * Nab;
    return to_motors({force[0] / terms.M(0, 0), (Nbb * force[1] - Nab * force[2]) / determinant,
                      (Naa * force[2] - Nab * force[1]) / determinant});
  }

  Vector3 end_effector(const Vector3& psi) const {
    const Vector3 q = basis(psi);
    const Point E = end_point(q);
    return in_space(q[0], E.rho, E.zeta + n_.L1);
  }

  /// dE / d psi.
  Matrix3 end_effector_jacobian(const Vector3& psi) const {
    const Vector3 q = basis(psi);
    const Point E = end_point(q);
    Matrix3 J;
    J.col(0) = E.rho * sideways(q[0]);
    J.col(1) = in_space(q[0], E.rho_a, E.zeta_a);
    J.col(2) = in_space(q[0], E.rho_b, E.zeta_b);
    return J * basis_jacobian();
  }

  Vector3 end_effector_velocity(const Vector3& psi, const Vector3& psid) const {
    return end_effector_jacobian(psi) * psid;
  }

  Vector3 end_effector_acceleration(const Vector3& psi, const Vector3& psid, const Vector3& psidd) const {
    const Vector3 q = basis(psi), qd = basis_jacobian() * psid;
    const Point E = end_point(q);
    const T rho_d = E.rho_a * qd[1] + E.rho_b * qd[2];
    const auto [rho_dd, zeta_dd] = velocity_part(end_arms(q), qd);
    const Vector3 centripetal = in_space(q[0], rho_dd - E.rho * qd[0] * qd[0], zeta_dd);
    return end_effector_jacobian(psi) * psidd + centripetal + 2 * rho_d * qd[0] * sideways(q[0]);
  }

  Energy energy(const Vector3& psi, const Vector3& psid) const {
    const Vector3 q = basis(psi), qd = basis_jacobian() * psid;
    Energy sum{qd.dot(in_basis(psi, psid).M * qd) / 2, n_.base_mass * n_.gravity * n_.base_height};
    for (const Body& body : bodies(q))
      sum.potential += body.link.mass * n_.gravity * (n_.L1 + point(body.arms).zeta);
    return sum;
  }

 private:
  /// An absolute angle and its partial derivatives by a and b.
  struct Angle {
    T value, by_a, by_b;
  };
  /// A vector of the plane, (x, y) in axes that stand at an absolute angle.
  struct Arm {
    T x, y;
    Angle at;
  };
  using Arms = std::array<Arm, 3>;  // the sum of three reaches every centre of mass
  struct Body {
    Link<T> link;
    Arms arms;   // from the shoulder to the centre of mass
    Angle spin;  // of the link's own axes
  };
  /// A point of the plane and its partial derivatives by a and b.
  struct Point {
    T rho{}, zeta{}, rho_a{}, rho_b{}, zeta_a{}, zeta_b{};
  };
  struct Lagrange {
    Matrix3 M = Matrix3::Zero();
    Vector3 h = Vector3::Zero();
  };

  Vector3 basis(const Vector3& psi) const { return basis_jacobian() * psi; }

  Vector3 to_motors(const Vector3& qdd) const {
    const T psi1 = n_.r1 * qdd[0];
    const T sun2 = (1 + 1 / n_.r2) / n_.r1 * psi1, sun3 = (1 + 1 / n_.r4) / n_.r1 * psi1;
    return {psi1, n_.r2 * (sun2 - n_.r3 * qdd[1]), n_.r4 * (sun3 - n_.r5 * qdd[2])};
  }

  /// The generalized forces on (q1, a, b) of motor torques: equal virtual work.
  Vector3 to_basis_force(const Vector3& tau) const {
    const T on_a = -n_.r2 * n_.r3 * tau[1], on_b = -n_.r4 * n_.r5 * tau[2];
    const Matrix3 B = basis_jacobian();
    return {n_.r1 * (tau[0] - B(1, 0) * on_a - B(2, 0) * on_b), on_a, on_b};
  }

  Angle angle_a(const Vector3& q) const { return {q[1], T(1), T(0)}; }
  Angle angle_b(const Vector3& q) const { return {q[2], T(0), T(1)}; }
  Angle angle_c(const Vector3& q) const {
    const T k = n_.q5_o - n_.r6 * (pi<T>() + n_.beta - n_.gamma_o);
    return {(1 + n_.r6) * q[1] - n_.r6 * q[2] + k, 1 + n_.r6, -n_.r6};
  }
  Angle angle_5(const Vector3& q) const { return {q[1] - n_.beta, T(1), T(0)}; }
  Angle angle_6(const Vector3& q) const { return {q[2] + pi<T>(), T(0), T(1)}; }

  Arms end_arms(const Vector3& q) const {
    return {Arm{n_.L2, T(0), angle_a(q)}, Arm{n_.L3, T(0), angle_c(q)}, Arm{T(0), T(0), angle_c(q)}};
  }
  Point end_point(const Vector3& q) const { return point(end_arms(q)); }

  /// Links 2 to 6 and the payload, each with the arms from the shoulder to its centre.
  std::array<Body, 6> bodies(const Vector3& q) const {
    const Angle a = angle_a(q), b = angle_b(q), c = angle_c(q), five = angle_5(q), six = angle_6(q);
    const Arm none{T(0), T(0), a};
    const auto centre = [](const Link<T>& link, const T& length, const Angle& at) {
      return Arm{length + link.x, link.y, at};
    };
    const Arm upper{n_.L2, T(0), a}, crank{n_.L4, T(0), b}, coupler{n_.L5, T(0), five};
    Link<T> payload;
    payload.mass = n_.payload;
    return {Body{n_.link2, {centre(n_.link2, n_.L2, a), none, none}, a},
            Body{n_.link3, {upper, centre(n_.link3, n_.L3, c), none}, c},
            Body{n_.link4, {centre(n_.link4, n_.L4, b), none, none}, b},
            Body{n_.link5, {crank, centre(n_.link5, n_.L5, five), none}, five},
            Body{n_.link6, {crank, coupler, centre(n_.link6, n_.L4, six)}, six},
            Body{payload, end_arms(q), c}};
  }

  Point point(const Arms& arms) const {
    using std::cos;
    using std::sin;
    Point sum;
    for (const Arm& arm : arms) {
      const T cosine = cos(arm.at.value), sine = sin(arm.at.value);
      const T rho = arm.x * cosine - arm.y * sine, zeta = arm.x * sine + arm.y * cosine;
      sum.rho += rho;
      sum.zeta += zeta;
      sum.rho_a -= arm.at.by_a * zeta;
      sum.rho_b -= arm.at.by_b * zeta;
      sum.zeta_a += arm.at.by_a * rho;
      sum.zeta_b += arm.at.by_b * rho;
    }
    return sum;
  }

  /// The part of (rho'', zeta'') without a'' and b'': each arm's centripetal acceleration.
  std::array<T, 2> velocity_part(const Arms& arms, const Vector3& qd) const {
    using std::cos;
    using std::sin;
    std::array<T, 2> sum{T(0), T(0)};
    for (const Arm& arm : arms) {
      const T cosine = cos(arm.at.value), sine = sin(arm.at.value);
      const T rate = arm.at.by_a * qd[1] + arm.at.by_b * qd[2];
      sum[0] -= rate * rate * (arm.x * cosine - arm.y * sine);
      sum[1] -= rate * rate * (arm.x * sine + arm.y * cosine);
    }
    return sum;
  }

  /// Lagrange's equations in (q1, a, b), body by body:
  ///   q1: J q1'' + J' q1'
  ///   i:  sum_j N_ij q_j'' + m (rho_i rho''_0 + zeta_i zeta''_0) - 1/2 q1'^2 dJ/dq_i + m g zeta_i
  Lagrange in_basis(const Vector3& psi, const Vector3& psid) const {
    using std::cos;
    using std::sin;
    const Vector3 q = basis(psi), qd = basis_jacobian() * psid;
    Lagrange sum;
    sum.M(0, 0) = n_.base_inertia;
    for (const Body& body : bodies(q)) {
      const Link<T>& link = body.link;
      const Point P = point(body.arms);
      const auto [rho_0, zeta_0] = velocity_part(body.arms, qd);
      const T cosine = cos(body.spin.value), sine = sin(body.spin.value);
      const T J = link.mass * P.rho * P.rho + link.I_along * sine * sine + link.I_across * cosine * cosine;
      const T J_spin = 2 * (link.I_along - link.I_across) * sine * cosine;
      const std::array<T, 2> rho_i{P.rho_a, P.rho_b}, zeta_i{P.zeta_a, P.zeta_b};
      const std::array<T, 2> spin_i{body.spin.by_a, body.spin.by_b};
      sum.M(0, 0) += J;
      for (int i = 0; i < 2; ++i) {
        const T J_i = 2 * link.mass * P.rho * rho_i[i] + J_spin * spin_i[i];
        sum.h[0] += J_i * qd[i + 1] * qd[0];
        sum.h[i + 1] +=
            link.mass * (rho_i[i] * rho_0 + zeta_i[i] * (zeta_0 + n_.gravity)) - J_i * qd[0] * qd[0] / 2;
        for (int j = 0; j < 2; ++j)
          sum.M(i + 1, j + 1) += link.mass * (rho_i[i] * rho_i[j] + zeta_i[i] * zeta_i[j]) +
                                 link.I_normal * spin_i[i] * spin_i[j];
      }
    }
    return sum;
  }

  static Vector3 in_space(const T& q1, const T& radial, const T& height) {
    using std::cos;
    using std::sin;
    return {radial * cos(q1), radial * sin(q1), height};
  }
  static Vector3 sideways(const T& q1) {
    using std::cos;
    using std::sin;
    return {-sin(q1), cos(q1), T(0)};
  }

  RobotNumbers<T> n_;
};

}  // namespace mixloop::oracle
