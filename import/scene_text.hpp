// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "import/choices.hpp"

namespace mixloop {

/// The scene's YAML without its head. `tip`: a link; `axes`: of the end effector, "xyz" or fewer, empty for
/// all; `home`: of the motors, then the free ones.
std::string scene_text(const Robot& robot, const SceneNames& names, const Roles& roles, int tip,
                       const std::string& axes, const std::vector<double>& home);

}  // namespace mixloop
