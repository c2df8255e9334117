// SPDX-License-Identifier: MIT
#include "bench/work_precision.hpp"

namespace mixloop::bench {

void sundials_points(const Case&, const Keep&) {}

}  // namespace mixloop::bench
