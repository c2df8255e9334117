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
  return values;
}

}  // namespace mixloop
