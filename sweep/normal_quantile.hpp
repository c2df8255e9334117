// SPDX-License-Identifier: MIT
#pragma once

namespace mixloop {

/// x with Phi(x) = p, Phi the standard normal distribution's; 0 < p < 1. To 1e-15 of |x|, or of 1 where that
/// is less. M. J. Wichura, Algorithm AS 241, Applied Statistics 37 (1988), PPND16; its logarithm is the
/// program's own, so that no C library decides a bit.
double normal_quantile(double p);

}  // namespace mixloop
