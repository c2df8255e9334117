// SPDX-License-Identifier: MIT
#include "bench/engine.hpp"

namespace mixloop::bench {

void add_simbody(Engines&) {}

}  // namespace mixloop::bench
