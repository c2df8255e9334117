// SPDX-License-Identifier: MIT
#include "bench/closed_engine.hpp"

namespace mixloop::bench {

void add_simbody_four_bar(ClosedEngines&) {}
void add_simbody_planar_3rrr(ClosedEngines&) {}
void add_simbody_delta_robot(ClosedEngines&) {}

}  // namespace mixloop::bench
