// SPDX-License-Identifier: MIT
#include "dynamics/scene/scene.hpp"

#include <algorithm>

namespace mixloop {

int Scene::Closure::rows() const {
  switch (kind) {
    case Kind::coincide:
      return static_cast<int>(axes.size());
    case Kind::parallel:
      return 2;
    case Kind::align:
      return 3;
    default:
      return 1;
  }
}

std::span<const Scene::Independent> Scene::motors() const {
  const auto free = std::find_if(independent.begin(), independent.end(),
                                 [](const Independent& coordinate) { return !coordinate.driven; });
  return {independent.begin(), free};
}

bool Scene::turns(int coordinate) const {
  return !coordinates[static_cast<std::size_t>(coordinate)].constraint.dimension.same_powers(kLength);
}

int Scene::start_size() const {
  int numbers = 0;
  for (int j = 0; j < m(); ++j)
    if (coordinates[static_cast<std::size_t>(j)].is_solved()) numbers += turns(j) ? 3 : 1;
  return numbers;
}

std::vector<double> Scene::default_parameters() const {
  std::vector<double> values;
  for (const auto& parameter : parameters) values.push_back(parameter.value);
  if (friction_factor) values.push_back(1);
  return values;
}

bool Scene::has_friction() const {
  return std::any_of(coordinate_loads.begin(), coordinate_loads.end(),
                     [](const CoordinateLoad& load) { return !load.damping.is_zero(); });
}

}  // namespace mixloop
