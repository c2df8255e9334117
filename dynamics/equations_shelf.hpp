// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <mutex>
#include <tuple>

#include "dynamics/equations.hpp"

namespace mixloop {

/// Equations that are made once and handed out again, for experiments that share their scenes. Threads share
/// it, and wait for one that makes some.
class EquationsShelf {
 public:
  /// As equations_of. Scenes are told apart by where they are, not by what they say.
  std::shared_ptr<const Equations> of(const std::shared_ptr<const Scene>& scene, Evaluation how,
                                      const std::vector<Purpose>& purposes, Equations::Options options);

 private:
  using Key = std::tuple<const Scene*, Evaluation, std::vector<Purpose>, Equations::Options>;

  std::mutex mutex_;
  std::map<Key, std::shared_ptr<const Equations>> shelved_;  ///< these keep their scenes
};

/// Those of the shelf, or without one new ones.
std::shared_ptr<const Equations> shelved_equations(EquationsShelf* shelf,
                                                   const std::shared_ptr<const Scene>& scene, Evaluation how,
                                                   const std::vector<Purpose>& purposes,
                                                   Equations::Options options = {});

}  // namespace mixloop
