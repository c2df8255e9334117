// SPDX-License-Identifier: MIT
#include "dynamics/scene/scene.hpp"

namespace mixloop {

std::vector<double> Scene::default_parameters() const {
  std::vector<double> values;
  for (const auto& parameter : parameters) values.push_back(parameter.value);
  return values;
}

}  // namespace mixloop
