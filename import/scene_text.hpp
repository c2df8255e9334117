// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "import/robot.hpp"
#include "import/scene_names.hpp"

namespace mixloop {

/// What becomes of a robot's joints in a scene.
struct Roles {
  std::vector<int> motors, free;  ///< joints: the independent coordinates
  std::vector<int> mimics;        ///< joints that follow from them
};

/// The scene's YAML without its head.
/// `axes`: of the end effector, "xyz" or fewer; empty: all.
std::string scene_text(const Robot& robot, const SceneNames& names, const Roles& roles, int tip,
                       const std::string& axes, const std::vector<double>& home);

}  // namespace mixloop
