// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/scene/scene.hpp"

namespace mixloop {

/// Finds which blocks of an assembled scene are solved by corrections from a start, and which coordinates
/// need a start beside these: angles whose value counts, not their sine and cosine alone.
void find_starts(Scene& scene);

}  // namespace mixloop
