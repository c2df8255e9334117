// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "dynamics/scene/check_physical.hpp"
#include "dynamics/scene/scene.hpp"
#include "notation/document.hpp"

namespace mixloop {

/// Reads a scene; docs/scenes.md describes the format. Throws InputError, with file, line and column, for
/// everything that is no scene: nothing is guessed.
Scene load_scene(const NodePtr& document);
Scene load_scene(const std::filesystem::path& path);

/// The scene's defaults with `parameters:` (a mapping name -> value, or null) on top. Throws InputError for
/// an unknown name, a wrong dimension, or values for which the scene is none (a negative mass, an inertia
/// that no body can have).
std::vector<double> parameter_values(const Scene& scene, const NodePtr& overrides, std::vector<double> base);

}  // namespace mixloop
