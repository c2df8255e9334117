// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "dynamics/scene/scene.hpp"

namespace mixloop {

/// All of a scene that its equations of motion depend on, exactly (numbers as hexadecimal floats), without
/// names, places or comments: equal for two files that describe the same mechanism in the same order.
std::string canonical_text(const Scene& scene);

}  // namespace mixloop
