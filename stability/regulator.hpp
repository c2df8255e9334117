// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "stability/sampled_loop.hpp"

namespace mixloop {

/// The gain K (n_u x 2n) of u = -K x that makes sum x^T Q x + u^T R u least over all ticks to come, of
/// x_{k+1} = Phi x_k + Gamma u_k; Q and R are diagonal, `state` (2n, 0 or more) and `torque` (n_u, above 0).
/// By the doubling algorithm for the discrete Riccati equation (Chu, Fan & Lin 2005). Empty where there is
/// none: the torque doesn't reach what grows, or Q doesn't see it.
std::optional<Matrix> regulator_gain(const Held& held, const Vector& state, const Vector& torque);

}  // namespace mixloop
