// SPDX-License-Identifier: MIT
#include "dynamics/scene/fully_driven.hpp"

#include "dynamics/scene/canonical.hpp"

namespace mixloop {

std::shared_ptr<const Scene> fully_driven(std::shared_ptr<const Scene> scene) {
  if (scene->n_u() == scene->n()) return scene;
  auto driven = std::make_shared<Scene>(*scene);
  for (auto& coordinate : driven->independent) coordinate.driven = true;
  driven->canonical = canonical_text(*driven);
  return driven;
}

}  // namespace mixloop
