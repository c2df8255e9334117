// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dynamics/procedure/purpose.hpp"
#include "dynamics/program/source.hpp"
#include "dynamics/scene/scene.hpp"

namespace mixloop {

/// The scene's programs as one C++17 file without dependencies, for a user's own firmware: a C interface,
/// and in its head where it comes from, what each function takes and gives, and its operations.
std::string firmware_source(const std::shared_ptr<const Scene>& scene, const std::vector<Purpose>& purposes,
                            Trigonometry trigonometry);

}  // namespace mixloop
