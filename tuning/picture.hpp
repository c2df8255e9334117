// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "tuning/problem.hpp"

namespace mixloop {

/// Draws the experiment before and after it was tuned, nothing drawn: the position error along the path, each
/// motor's torque, and where the sampled loop is stable, tick across and delay upwards; what there is of
/// them. As SVG or PNG after the file's ending, by gnuplot. Throws InputError for another ending, RunFault
/// where gnuplot is missing or fails.
void draw_tuned(const Problem& problem, const std::vector<double>& before, const std::vector<double>& after,
                const std::filesystem::path& file);

}  // namespace mixloop
