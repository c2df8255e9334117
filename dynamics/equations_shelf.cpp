// SPDX-License-Identifier: MIT
#include "dynamics/equations_shelf.hpp"

namespace mixloop {

std::shared_ptr<const Equations> EquationsShelf::of(const std::shared_ptr<const Scene>& scene, Evaluation how,
                                                    const std::vector<Purpose>& purposes,
                                                    Equations::Options options) {
  const std::lock_guard lock(mutex_);
  auto& equations = shelved_[{scene.get(), how, purposes, options}];
  if (!equations) equations = equations_of(scene, how, purposes, options);
  return equations;
}

std::shared_ptr<const Equations> shelved_equations(EquationsShelf* shelf,
                                                   const std::shared_ptr<const Scene>& scene, Evaluation how,
                                                   const std::vector<Purpose>& purposes,
                                                   Equations::Options options) {
  return shelf != nullptr ? shelf->of(scene, how, purposes, options)
                          : equations_of(scene, how, purposes, options);
}

}  // namespace mixloop
