// SPDX-License-Identifier: MIT
#pragma once

#include "notation/keys.hpp"

namespace mixloop {

/// What may stand in an experiment's `plant`, its `sensors` and `actuators`, in `real_time` and in each of
/// `faults`.
const Keys& plant_keys();
const Keys& sensor_keys();
const Keys& actuator_keys();
const Keys& real_time_keys();
const Keys& fault_keys();

}  // namespace mixloop
