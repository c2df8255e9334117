// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "sweep/setup.hpp"

namespace mixloop {

/// Writes a sweep's experiment with these values of what is varied into a file of its own, its scene beside
/// it (`NAME.scene.yaml`) where that is changed; `head`: comments that they begin with. Throws
/// RunFault("cannot_write").
void write_experiment(const std::filesystem::path& file, const std::string& head, const Setup& setup,
                      const std::vector<Override>& values);

/// Writes the experiment of a run so: `mixloop simulate` of it has the run's bytes.
void write_run(const std::filesystem::path& file, const Setup& setup, std::int64_t run);

}  // namespace mixloop
