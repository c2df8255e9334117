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

/// All that move have a motor but those named `free`, by the robot's name or the scene's. Throws InputError:
/// "unknown_value" for a name that is none of theirs, "no_motor", "too_large".
Roles roles_of(const Robot& robot, const SceneNames& names, const std::vector<std::string>& free,
               const std::string& file);

/// A joint's position over that of the one that it follows: itself, unless it mimics another.
struct Following {
  int joint = 0;
  double slope = 1, offset = 0;
};
Following following(const Robot& robot, int joint);

/// The links that move and on which nothing hangs.
std::vector<int> moved_leaves(const Robot& robot);
/// Of them the one that most joints move, of several the first.
int farthest(const Robot& robot, const std::vector<int>& leaves);
/// The link of that name; throws InputError("unknown_value") for none, or one that no joint moves.
int named_tip(const Robot& robot, const std::string& name);

}  // namespace mixloop
