// SPDX-License-Identifier: MIT
#include "bench/closed_engine.hpp"

namespace mixloop::bench {

void add_mujoco_four_bar(ClosedEngines&, const FourBarHome&) {}
void add_mujoco_planar_3rrr(ClosedEngines&, const ClosedState&) {}
void add_mujoco_delta_robot(ClosedEngines&, const ClosedState&) {}

}  // namespace mixloop::bench
