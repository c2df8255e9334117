// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace mixloop {

/// Makes the folder (with its parents) where results are to be kept, so that a run does not end in a folder
/// that cannot be written. Throws RunFault("cannot_write").
void prepare_folder(const std::filesystem::path& folder);

/// The same for a run that begins: what an earlier one left there (its result, trajectory, inputs, ages, log
/// and report) is removed, so that files of two runs never stand side by side.
void begin_run_folder(const std::filesystem::path& folder);

}  // namespace mixloop
