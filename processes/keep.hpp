// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "loop/output_folder.hpp"
#include "loop/recorded_plant.hpp"
#include "loop/result.hpp"

namespace mixloop {

/// Keeps a run: trajectory.csv, inputs.json, of one in real time ages.csv, and at last result.json, which has
/// the others' SHA-256 in it as `files`. Throws RunFault("cannot_write").
void keep(const std::filesystem::path& folder, const RecordedPlant& run, Result& result);

/// Its result.json alone.
void keep_result(const std::filesystem::path& folder, const Result& result);

}  // namespace mixloop
