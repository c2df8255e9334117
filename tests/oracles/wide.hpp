// SPDX-License-Identifier: MIT
// The wide float of the oracles: 113 bits, about 34 decimal digits.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>

namespace mixloop::oracle {

using Wide = boost::multiprecision::cpp_bin_float_quad;

}  // namespace mixloop::oracle
