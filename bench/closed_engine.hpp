// SPDX-License-Identifier: MIT
// What the benchmark of mechanisms whose chains close asks of an engine: forward dynamics at poses that are
// closed already, so that nobody assembles.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace mixloop::bench {

/// Independent coordinates, and all joints' as the scene has them, positions and rates.
struct ClosedState {
  std::vector<double> psi, psid, tau, q, qd;
};

/// One row of the table. `forward` gives the accelerations of the independent coordinates.
struct ClosedEngine {
  std::string name;
  double tolerance = 1e-11;  ///< relative error against 113 bits that it must keep
  std::function<void(const ClosedState&, double* psidd)> forward;
};

using ClosedEngines = std::vector<ClosedEngine>;

/// Home of scenes/four_bar.yaml, about which peers are put together: elbow and rocker beside a crank at 60
/// degrees.
struct FourBarHome {
  double crank, elbow, rocker;
};

/// A state near home, closed: what peers are put together at.
void add_mujoco_planar_3rrr(ClosedEngines& engines, const ClosedState& home);
void add_simbody_planar_3rrr(ClosedEngines& engines);
void add_mujoco_delta_robot(ClosedEngines& engines, const ClosedState& home);
void add_simbody_delta_robot(ClosedEngines& engines);

void add_mujoco_four_bar(ClosedEngines& engines, const FourBarHome& home);
void add_simbody_four_bar(ClosedEngines& engines);

}  // namespace mixloop::bench
