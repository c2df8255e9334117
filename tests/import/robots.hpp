// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>

#include "import/import_urdf.hpp"

namespace mixloop {

constexpr std::array kRobots = {"baxter_arm", "cart_pole", "double_pendulum",  "gen3",  "gripper",  "iiwa7",
                                "irb_120",    "panda",     "mini_cheetah_leg", "scara", "puma_560", "ur5"};

inline std::string robot_file(const std::string& name) {
  return MIXLOOP_SOURCE "/tests/import/robots/" + name + ".urdf";
}

/// With published moments that no body could have, of the PUMA 560 and the leg.
inline Imported imported_robot(const std::string& name, ImportOptions options = {}) {
  options.any_inertia = name == "puma_560" || name == "mini_cheetah_leg";
  return import_urdf_file(robot_file(name), options);
}

}  // namespace mixloop
