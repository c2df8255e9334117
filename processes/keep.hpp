// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "loop/recorded_plant.hpp"
#include "loop/result.hpp"

namespace mixloop {

/// Makes the folder (with its parents) where results are to be kept, so that a run does not end in a folder
/// that cannot be written. Throws RunFault("cannot_write").
void prepare_folder(const std::filesystem::path& folder);

/// Keeps a run: result.json, trajectory.csv and inputs.json. Throws RunFault("cannot_write").
void keep(const std::filesystem::path& folder, const RecordedPlant& run, const Result& result);

/// Its result.json alone.
void keep_result(const std::filesystem::path& folder, const Result& result);

}  // namespace mixloop
