// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/procedure/matrix.hpp"

namespace mixloop {

/// What a step of the classical Runge-Kutta method writes; sized once.
struct Rk4Workspace {
  explicit Rk4Workspace(Eigen::Index size) : k1(size), k2(size), k3(size), k4(size), x(size) {}
  Vector k1, k2, k3, k4, x;
};

/// One step of the classical fourth-order Runge-Kutta method (Hairer, Norsett & Wanner, II.1, table 1.2), in
/// place. `rate(stage, c, x, dx)` writes x' at t + c h; stages count 0, 1, 2, 3, with c = 0, 1/2, 1/2, 1.
template <class Rate>
void rk4_step(Vector& x, double h, const Rate& rate, Rk4Workspace& ws) {
  rate(0, 0.0, x, ws.k1);
  ws.x = x + (h / 2) * ws.k1;
  rate(1, 0.5, ws.x, ws.k2);
  ws.x = x + (h / 2) * ws.k2;
  rate(2, 0.5, ws.x, ws.k3);
  ws.x = x + h * ws.k3;
  rate(3, 1.0, ws.x, ws.k4);
  x += (h / 6) * (ws.k1 + 2 * ws.k2 + 2 * ws.k3 + ws.k4);
}

}  // namespace mixloop
