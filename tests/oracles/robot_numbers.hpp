// SPDX-License-Identifier: MIT
// Appendix B's numbers, as the closed form takes them.
#pragma once

#include <cmath>

namespace mixloop::oracle {

/// A link of the robot as Table B-2 has it, reduced to what a body of the arm's plane needs.
template <class T>
struct Link {
  T mass{};
  T x{}, y{};    ///< centre of mass along the link and across it, in the plane
  T I_along{};   ///< moment of inertia about the link's own direction
  T I_across{};  ///< about the in-plane direction across the link
  T I_normal{};  ///< about the plane's normal
};

/// Appendix B in SI units and radians. Body 1's centre lies on Z0: only its I_yy (about Z0) counts.
template <class T>
struct RobotNumbers {
  T L1{}, L2{}, L3{}, L4{}, L5{};
  T r1{}, r2{}, r3{}, r4{}, r5{}, r6{};
  T beta{}, q5_o{}, gamma_o{};
  T base_mass{}, base_height{}, base_inertia{};  ///< of body 1; the height over Z0 = 0
  Link<T> link2, link3, link4, link5, link6;
  T payload{};  ///< a point mass at E
  T gravity{};  ///< along -Z0
};

template <class T>
T pi() {
  using std::acos;
  return acos(T(-1));
}

/// The numbers as printed (decimals exact in T), Table B-2's link 3 with its axes turned by alpha = 90 deg.
template <class T>
RobotNumbers<T> paper_numbers(T payload = T(5), T gravity = T(981) / 100) {
  const auto centi = [](int hundredths) { return T(hundredths) / 100; };
  const auto milli = [](int thousandths) { return T(thousandths) / 1000; };
  const auto degrees = [](int angle) { return pi<T>() * angle / 180; };
  RobotNumbers<T> numbers;
  numbers.L1 = numbers.L2 = numbers.L3 = centi(30);
  numbers.L4 = centi(15);
  numbers.L5 = centi(26);
  numbers.r1 = numbers.r3 = numbers.r5 = T(8);
  numbers.r2 = numbers.r4 = numbers.r6 = T(2);
  numbers.beta = degrees(57);
  numbers.q5_o = degrees(46);
  numbers.gamma_o = degrees(115);
  numbers.base_mass = T(2);
  numbers.base_height = numbers.L1 - centi(15);
  numbers.base_inertia = milli(8);
  // Rows 2 and 4 to 6: x along the link, y across it, z the normal. Row 3: x along, z across, y the normal.
  numbers.link2 = {centi(311), milli(-125), milli(-43), milli(3), milli(13), milli(16)};
  numbers.link3 = {centi(22), milli(-188), T(0), milli(4), milli(20), milli(20)};
  numbers.link4 = {centi(15), milli(-100), T(0), milli(10), milli(15), milli(20)};
  numbers.link5 = {centi(6), milli(-130), T(0), milli(0), milli(4), milli(4)};
  numbers.link6 = {centi(15), milli(-50), T(0), milli(10), milli(15), milli(20)};
  numbers.payload = payload;
  numbers.gravity = gravity;
  return numbers;
}

}  // namespace mixloop::oracle
