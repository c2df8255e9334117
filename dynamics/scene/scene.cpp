// SPDX-License-Identifier: MIT
#include "dynamics/scene/scene.hpp"

#include <algorithm>

namespace mixloop {

std::span<const Scene::Independent> Scene::motors() const {
  const auto free = std::find_if(independent.begin(), independent.end(),
                                 [](const Independent& coordinate) { return !coordinate.driven; });
  return {independent.begin(), free};
}

std::vector<double> Scene::default_parameters() const {
  std::vector<double> values;
  for (const auto& parameter : parameters) values.push_back(parameter.value);
  if (friction_factor) values.push_back(1);
  return values;
}

bool Scene::has_friction() const {
  return std::ranges::any_of(coordinate_loads, [](const auto& load) { return !load.damping.is_zero(); }) ||
         std::ranges::any_of(along_loads, [](const auto& load) { return !load.law.damping.is_zero(); }) ||
         std::ranges::any_of(between_loads, [](const auto& load) { return !load.law.damping.is_zero(); });
}

}  // namespace mixloop
