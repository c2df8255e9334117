// SPDX-License-Identifier: MIT
#include "bench/engine.hpp"

namespace mixloop::bench {

void add_mujoco(Engines&) {}

}  // namespace mixloop::bench
