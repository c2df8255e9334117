// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "loop/output_folder.hpp"
#include "loop/recorded_plant.hpp"
#include "loop/result.hpp"

namespace mixloop {

/// Keeps a run: result.json, trajectory.csv and inputs.json. Throws RunFault("cannot_write").
void keep(const std::filesystem::path& folder, const RecordedPlant& run, const Result& result);

/// Its result.json alone.
void keep_result(const std::filesystem::path& folder, const Result& result);

}  // namespace mixloop
