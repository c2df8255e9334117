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

bool Scene::is_length(const ClosureRow& row) const {
  const Closure& closure = closures[static_cast<std::size_t>(row.closure)];
  return closure.has_points() ||
         (closure.kind == Closure::Kind::zero && closure.value.dimension.same_powers(kLength));
}

int Scene::start_size() const {
  int numbers = 0;
  for (int j : started) numbers += turns(j) ? 3 : 1;
  return numbers;
}

int Scene::corrections() const {
  std::size_t number = 0;
  for (const auto& block : blocks) number += block.corrected().size();
  return static_cast<int>(number);
}

int Scene::started_rates() const {
  const bool torn = std::ranges::any_of(blocks, [](const Block& block) { return !block.cut.empty(); });
  return torn ? static_cast<int>(started.size()) * (n() + 1) : 0;
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
