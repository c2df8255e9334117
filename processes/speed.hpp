// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mixloop {

/// `max` is 0 (no pacing), else a positive factor of real time. Throws InputError.
double speed_of(const std::string& text);

}  // namespace mixloop
