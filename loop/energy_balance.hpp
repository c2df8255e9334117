// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "loop/experiment.hpp"

namespace mixloop {

/// What beside the motors changes the energy of an experiment's plant, as other_work of its scene, or a fault
/// in a parameter. Empty where nothing does: there E - E_0 - W, the motors' work W taken off, is the
/// integrator's error and rounding alone.
///
/// How exact W is: it is integrated along with the motion by the same method (with Rosenbrock's it is the
/// torque times the way), so of a torque that is held it is tau . (psi(k+1) - psi(k)) to rounding, whatever
/// the steps are; of a torque that varies within a tick (control: continuous, drives with a lag, friction or
/// ripple), and in coordinates that were switched to, it is as exact as the method is. Rounding adds some
/// 1e-16 of |W| a tick.
std::string other_work_in(const Experiment& experiment);

}  // namespace mixloop
