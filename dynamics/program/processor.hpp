// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mixloop {

/// Whether this processor has fused multiply-adds; where it hasn't, programs give the same bits slower.
bool has_fma();
/// States that are evaluated together in lanes: 8 with 512-bit vectors, else 4.
int lane_width();
/// What machine code that was built for this processor is good for: its model and features.
const std::string& processor_identity();

}  // namespace mixloop
