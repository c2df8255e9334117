// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "plant/arrivals.hpp"

namespace mixloop {

/// When the commands of a run in real time arrived, as CSV: tick, offset_ns (plant time after the tick's
/// start), command (the tick it answers), how the controller came to it (`law`, `extrapolated N` ticks,
/// `safe`); and between them, without offset and command, faults by message and safe states that were not
/// brought by missed commands. Its SHA-256. Throws RunFault("cannot_write").
std::string write_arrivals(const std::filesystem::path& file, const Arrivals& arrivals);

/// Throws InputError, with the line, for what is no such file or could not have happened.
Arrivals read_arrivals(const std::filesystem::path& file);

}  // namespace mixloop
