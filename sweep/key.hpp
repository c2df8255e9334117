// SPDX-License-Identifier: MIT
#pragma once

#include "loop/experiment.hpp"
#include "sweep/variation.hpp"

namespace mixloop {

/// Throws InputError at the variation's place where its key is no entry that the experiment or, behind
/// `scene.`, its scene has or may have: the nearest one is named.
void require_key(const Variation& variation, const NodePtr& experiment, const ExperimentScenes& scenes);

/// Whether a key is an entry of the scene's own.
bool is_of_scene(const std::string& key);

}  // namespace mixloop
