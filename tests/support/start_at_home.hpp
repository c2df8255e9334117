// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "dynamics/scene/scene.hpp"
#include "notation/functions/sincos.hpp"

namespace mixloop {

/// Where a scene's closures are solved from at home (Scene::start_size numbers).
inline std::vector<double> start_at_home(const Scene& scene) {
  std::vector<double> numbers;
  for (int j : scene.started) {
    const double home = scene.coordinates[static_cast<std::size_t>(j)].home;
    numbers.push_back(home);
    if (!scene.turns(j)) continue;
    numbers.push_back(mixloop_functions::cos(home));
    numbers.push_back(mixloop_functions::sin(home));
  }
  return numbers;
}

}  // namespace mixloop
