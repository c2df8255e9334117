// SPDX-License-Identifier: MIT
// Chains of any length, as text of scenes: how programs grow with a mechanism's size.
#pragma once

#include <string>

namespace mixloop::oracle {

/// n revolute joints in series, their axes alternately turned by +90 and -90 degrees, a body with a full
/// inertia tensor on each.
std::string serial_chain(int n);

/// n revolute joints in series that a few motors turn, each motor those of every so many links.
std::string coiled_chain(int n, int motors = 1);

/// n parallelograms, each on the coupler of the one before and in a plane at right angles to it; three bodies
/// and three dependent coordinates a stage, the constraints linear.
std::string parallelogram_chain(int n);

/// n four-bar loops in a row, each one's rocker the next one's crank, closed by closures: one motor, 3 n
/// bodies and coordinates (scenes/four_bar_chain.yaml is the one of 4).
std::string four_bar_chain_of(int n);

}  // namespace mixloop::oracle
