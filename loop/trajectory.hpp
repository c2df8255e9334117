// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "loop/recorder.hpp"

namespace mixloop {

/// Writes the recorded ticks as CSV, a line each, numbers that read back to the same double: t, psi, psid,
/// tau (commanded), tau_applied, then the end effector's position, velocity and acceleration, desired and
/// actual, the energies and the motors' work, and where the motors should be; what is desired with a path
/// alone, the end effector's where the scene names one. Throws RunFault("cannot_write").
std::string write_trajectory(const std::filesystem::path& file, const Experiment& experiment,
                             const Plan& plan, const Recorder& recorder);

}  // namespace mixloop
