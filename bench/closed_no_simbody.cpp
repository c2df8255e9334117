// SPDX-License-Identifier: MIT
#include "bench/closed_engine.hpp"

namespace mixloop::bench {

void add_simbody_four_bar(ClosedEngines&) {}

}  // namespace mixloop::bench
