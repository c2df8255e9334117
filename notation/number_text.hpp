// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mixloop {

/// A number with so many digits behind its point; in powers of ten where it would have more than nine before
/// it.
std::string fixed(double value, int digits);

}  // namespace mixloop
