// SPDX-License-Identifier: MIT
#include "dynamics/scene/time_dependence.hpp"

#include <algorithm>

namespace mixloop {
namespace {

bool timed(const Formula& formula) {
  return depends_on(formula, [](int symbol) { return symbol == Symbols::kTime; });
}

}  // namespace

bool constraints_depend_on_time(const Scene& scene) {
  return std::any_of(scene.coordinates.begin(), scene.coordinates.end(),
                     [](const auto& coordinate) { return timed(coordinate.constraint); }) ||
         std::any_of(scene.closures.begin(), scene.closures.end(),
                     [](const auto& closure) { return timed(closure.value); });
}

bool loads_depend_on_time(const Scene& scene) {
  return std::any_of(scene.loads.begin(), scene.loads.end(),
                     [](const auto& load) {
                       return std::any_of(load.force.begin(), load.force.end(), timed) ||
                              std::any_of(load.moment.begin(), load.moment.end(), timed);
                     }) ||
         std::any_of(scene.along_loads.begin(), scene.along_loads.end(),
                     [](const auto& load) { return timed(load.along); });
}

}  // namespace mixloop
