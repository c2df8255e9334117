// SPDX-License-Identifier: MIT
#include "bench/closed_engine.hpp"

namespace mixloop::bench {

void add_mujoco_four_bar(ClosedEngines&, const FourBarHome&) {}

}  // namespace mixloop::bench
