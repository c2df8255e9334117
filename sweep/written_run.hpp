// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "sweep/setup.hpp"

namespace mixloop {

/// Writes the experiment of a run into a file of its own, its scene beside it (`NAME.scene.yaml`) where that
/// is changed: `mixloop simulate` of it has the run's bytes. Throws RunFault("cannot_write").
void write_run(const std::filesystem::path& file, const Setup& setup, std::int64_t run);

}  // namespace mixloop
