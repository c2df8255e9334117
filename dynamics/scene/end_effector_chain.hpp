// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "dynamics/scene/scene.hpp"

namespace mixloop {

/// The scene with its end effector on a chain of its own, in which transforms in a row that make one
/// are one: so the chain is the same, in however many pieces it is told. The same scene where none do.
std::shared_ptr<const Scene> with_shortest_chain(std::shared_ptr<const Scene> scene);

}  // namespace mixloop
