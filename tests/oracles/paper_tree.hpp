// SPDX-License-Identifier: MIT
// The paper's robot as an open tree with linear constraints: Tables B-1 and B-2 row by row.
#pragma once

#include "tests/oracles/mixed_loop_robot.hpp"
#include "tests/oracles/multipliers.hpp"

namespace mixloop::oracle {

/// Six transforms, six bodies and the payload at the origin of frame 3.
template <class T>
Tree<T> paper_tree(T payload = T(5), T gravity = T(981) / 100) {
  const auto centi = [](int hundredths) { return T(hundredths) / 100; };
  const auto milli = [](int thousandths) { return T(thousandths) / 1000; };
  const T right_angle = pi<T>() / 2;
  Tree<T> tree;
  tree.coordinates = 6;
  tree.gravity = Vector3<T>(T(0), T(0), -gravity);
  const auto row = [&](int parent, int coordinate, const T& s, const T& a, const T& alpha) {
    tree.frames.push_back({parent, T(0), s, a, alpha, Motion::revolute, coordinate - 1, T(1)});
  };
  row(-1, 1, centi(30), T(0), right_angle);  // 0-1
  row(0, 2, T(0), centi(30), T(0));          // 1-2
  row(1, 5, T(0), centi(30), right_angle);   // 2-3
  row(0, 3, T(0), centi(15), T(0));          // 1-4
  row(3, 6, T(0), centi(26), T(0));          // 4-5
  row(4, 4, T(0), centi(15), T(0));          // 5-6
  const auto body = [&](int frame, const T& mass, int x_mm, int y_mm, int xx, int yy, int zz) {
    const Vector3<T> diagonal(milli(xx), milli(yy), milli(zz));
    tree.bodies.push_back({frame, mass, Vector3<T>(milli(x_mm), milli(y_mm), T(0)), diagonal.asDiagonal()});
  };
  body(0, T(2), 0, -150, 44, 8, 44);
  body(1, centi(311), -125, -43, 3, 13, 16);
  body(2, centi(22), -188, 0, 4, 20, 20);
  body(3, centi(15), -100, 0, 10, 15, 20);
  body(4, centi(6), -130, 0, 0, 4, 4);
  body(5, centi(15), -50, 0, 10, 15, 20);
  body(2, payload, 0, 0, 0, 0, 0);
  return tree;
}

/// (B-1) to (B-6), (B-2) divided by r3; C found by hand and constant, so gamma is zero.
template <class T>
ConstraintState<T> paper_constraints(const VectorX<T>& psi, const VectorX<T>& psid) {
  const auto degrees = [](int angle) { return pi<T>() * angle / 180; };
  const T r1(8), r2(2), r3(8), r4(2), r5(8), r6(2);
  MatrixX<T> C = MatrixX<T>::Zero(6, 3);
  C(0, 0) = 1 / r1;
  C.row(1) << (1 + 1 / r2) / (r1 * r3), -1 / (r2 * r3), T(0);
  C.row(2) << (1 + 1 / r4) / (r1 * r5), T(0), -1 / (r4 * r5);
  C.row(3) = C.row(2) - C.row(1);
  C.row(4) = -r6 * C.row(3);
  C.row(5) = -C.row(3);
  VectorX<T> q = C * psi;
  q[3] += pi<T>() + degrees(57);
  q[4] += degrees(46) - r6 * (pi<T>() + degrees(57) - degrees(115));
  q[5] -= degrees(57);
  return {q, C * psid, VectorX<T>::Zero(6), C};
}

}  // namespace mixloop::oracle
