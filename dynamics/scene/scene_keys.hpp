// SPDX-License-Identifier: MIT
#pragma once

#include "notation/keys.hpp"

namespace mixloop {

/// What may stand in a scene, and in the items of its lists.
const Keys& scene_keys();
const Keys& transform_keys();
const Keys& pose_keys();
const Keys& body_keys();
const Keys& load_keys();
const Keys& coordinate_load_keys();
const Keys& along_load_keys();
const Keys& between_load_keys();
/// Of a closure the keys are its kind's.
const Keys& coincide_keys();
const Keys& distance_keys();
const Keys& parallel_keys();
const Keys& align_keys();
const Keys& zero_keys();
const Keys& end_effector_keys();
/// Of a solid the keys are its shape's.
const Keys& box_keys();
const Keys& sphere_keys();
const Keys& round_keys();

}  // namespace mixloop
