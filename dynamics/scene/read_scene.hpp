// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/scene/scene.hpp"
#include "notation/document.hpp"

namespace mixloop {

/// What a scene's document says, checked as far as a file alone can be: keys, names, units, the tree of its
/// frames. Throws InputError.
Scene read_scene(const NodePtr& document);

}  // namespace mixloop
