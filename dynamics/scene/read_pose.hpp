// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "dynamics/scene/draft.hpp"

namespace mixloop {

/// Whether an entry of `transforms` is a pose or a joint. Throws InputError where it is Denavit and
/// Hartenberg's transform too.
bool is_pose(const Mapping& entry);

/// Trans(at) Rz(yaw) Ry(pitch) Rx(roll), then the joint about or along an axis in the axes of the frame that
/// is made, as transforms in a row, with nothing but their numbers and place. Throws InputError.
std::vector<Scene::Transform> read_pose(const Mapping& entry, SceneDraft& draft);

}  // namespace mixloop
