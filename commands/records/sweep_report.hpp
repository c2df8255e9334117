// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mixloop {

/// Makes the page of the sweep in a folder, and says so, to people or as JSON. Throws InputError: where
/// nothing is there yet ("missing_runs"), what makes it.
void report_sweep(const std::filesystem::path& folder, const std::string& page,
                  const std::filesystem::path& out, bool json);

}  // namespace mixloop
