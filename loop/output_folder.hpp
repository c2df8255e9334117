// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace mixloop {

/// Makes the folder (with its parents) where results are to be kept, so that a run does not end in a folder
/// that cannot be written. Throws RunFault("cannot_write").
void prepare_folder(const std::filesystem::path& folder);

}  // namespace mixloop
