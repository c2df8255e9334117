// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "loop/experiment.hpp"

namespace mixloop {

/// In single quotes where it must be, as a shell takes it.
std::string shell_quoted(const std::string& text);

/// `mixloop simulate EXPERIMENT --set KEY=VALUE ...`.
std::string simulate_command(const std::filesystem::path& experiment, const std::vector<Override>& all,
                             const std::vector<Override>& of_the_run);

}  // namespace mixloop
