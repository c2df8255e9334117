// SPDX-License-Identifier: MIT
#pragma once

#include "stability/sampled_loop.hpp"

namespace mixloop {

/// What became of a small disturbance.
enum class Fate {
  decays,     ///< below a thousandth
  grows,      ///< above a thousandfold, or not finite
  undecided,  ///< neither in 20,000 ticks
};
std::string_view name_of(Fate fate);

/// Simulates plant and controller, with all their nonlinearity, that hold the reference of the path's start,
/// the torque held from command to command: motors off by 1e-6 rad each beside motors that aren't. A constant
/// torque makes the reference an equilibrium, as the linearisation has it.
Fate fate_of_disturbance(const Experiment& experiment, const Plan& plan, const Sampling& sampling);

}  // namespace mixloop
