// SPDX-License-Identifier: MIT
#include "dynamics/scene/energy_balance.hpp"

#include "dynamics/scene/time_dependence.hpp"

namespace mixloop {

std::string other_work(const Scene& scene) {
  if (scene.has_friction()) return "the scene's damping takes energy";
  if (constraints_depend_on_time(scene)) return "constraints that depend on time do work";
  if (!scene.loads.empty() || loads_depend_on_time(scene)) return "external forces and moments do work";
  return {};
}

}  // namespace mixloop
