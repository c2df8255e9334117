// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "dynamics/scene/scene.hpp"

namespace mixloop::bench {

/// The paper's robot, the loop of its pantograph told by a closure in place of (B-4) and (B-6), in the three
/// ways that a block may be solved: found to be linear; by a dyad, where a parameter in the loop leaves it no
/// relation that holds for all of its values; by Newton's method, which solves all blocks of a scene from
/// starts.
struct Pantographs {
  std::shared_ptr<const Scene> linear, dyad, newton;
};
Pantographs pantographs();

}  // namespace mixloop::bench
