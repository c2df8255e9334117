// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "dynamics/scene/scene.hpp"

namespace mixloop {

/// What beside the motors adds to a mechanism's energy, or takes from it, in words: with it, kinetic energy
/// and potential (Purpose::energy) don't change by the motors' work alone. Empty where nothing does.
std::string other_work(const Scene& scene);

}  // namespace mixloop
