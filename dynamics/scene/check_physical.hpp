// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "dynamics/scene/scene.hpp"

namespace mixloop {

/// Throws InputError when a mass is negative, an inertia is not positive semidefinite, or anything is not
/// finite at these parameter values, at home at t = 0.
void check_physical(const Scene& scene, const std::vector<double>& parameters);

/// What no real body has but a rounded data sheet may, at the default parameters: a moment of inertia
/// larger than the sum of the two others. Each with its place.
std::vector<std::string> physical_warnings(const Scene& scene);

}  // namespace mixloop
