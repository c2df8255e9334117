// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/scene/scene.hpp"

namespace mixloop {

bool constraints_depend_on_time(const Scene& scene);
bool loads_depend_on_time(const Scene& scene);

}  // namespace mixloop
