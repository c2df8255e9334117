// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "import/robot.hpp"

namespace mixloop {

/// What links and joints are called in a scene.
struct SceneNames {
  std::vector<std::string> frames;  ///< of each link: its name; "0" of the first
  std::vector<std::string> joints;  ///< of each joint: its name, of letters, digits and _
  std::vector<std::pair<std::string, std::string>> renamed;  ///< what had to change: from, to
};

SceneNames names_in_scene(const Robot& robot);

/// `text` as a file's name may be: what else it has becomes _, and it has 64 characters at most.
std::string file_name_of(const std::string& text);

}  // namespace mixloop
