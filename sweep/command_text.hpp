// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "loop/experiment.hpp"

namespace mixloop {

/// `mixloop simulate EXPERIMENT --set KEY=VALUE ...`.
std::string simulate_command(const std::filesystem::path& experiment, const std::vector<Override>& all,
                             const std::vector<Override>& of_the_run);

}  // namespace mixloop
