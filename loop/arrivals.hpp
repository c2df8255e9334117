// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "loop/recorder.hpp"

namespace mixloop {

/// When the commands of a run in real time arrived, as CSV: tick, offset_ns (plant time after the tick's
/// start), command (the tick it answers). Throws RunFault("cannot_write").
void write_arrivals(const std::filesystem::path& file, const std::vector<Arrival>& arrivals);

/// Throws InputError, with the line, for what is no such file or could not have happened.
std::vector<Arrival> read_arrivals(const std::filesystem::path& file);

/// The run in real time that had these arrivals, in one process and at once: the same bytes. Where the
/// controller had to do without a reference, or the operator or another process interfered, it had other
/// commands.
void simulate_arrivals(const Experiment& experiment, const Plan& plan, const std::vector<Arrival>& arrivals,
                       Recorder& recorder, const std::function<bool(std::int64_t k)>& go_on);

}  // namespace mixloop
