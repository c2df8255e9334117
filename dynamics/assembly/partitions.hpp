// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "dynamics/scene/scene.hpp"

namespace mixloop {

/// A mechanism by one choice of its independent coordinates: the declared one, or one in which a declared
/// psi_i is solved for and an unknown q_j of a block is independent in its place.
struct Partition {
  std::shared_ptr<const Scene> scene;  ///< from_starts; motors act along what was declared
  int swapped = -1;                    ///< i; -1: as declared
  int freed = -1;                      ///< j, a coordinate of the declared scene
  int solved = -1;                     ///< psi_i's coordinate in `scene`
};

/// All partitions of an assembled scene whose chains close, the declared one first; those in which the
/// mechanism can be put together at home or about it, by the scene's defaults. The same scene gives the same
/// ones everywhere. Throws InputError("too_large") where they are too many to be compiled.
std::vector<Partition> partitions_of(const Scene& declared);

/// The same with another end effector: one that slides along z as far as the swapped psi_i goes, a metre a
/// radian. So its motion is told by what tells an end effector's.
std::vector<Partition> showing_swapped(std::vector<Partition> partitions);

}  // namespace mixloop
