// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "dynamics/scene/scene.hpp"

namespace mixloop {

/// The scene with a motor at every independent coordinate: what inverse dynamics ask for. The same one where
/// that is so already.
std::shared_ptr<const Scene> fully_driven(std::shared_ptr<const Scene> scene);

}  // namespace mixloop
