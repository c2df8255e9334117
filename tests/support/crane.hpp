// SPDX-License-Identifier: MIT
// A mechanism that has fewer motors than independent coordinates, with answers by hand: a trolley of 2 kg
// that a linear motor moves, and a load of 1 kg that hangs freely 1 m below it, at rest at 0. With g = 10
// m/s^2
//   3 x'' - cos(swing) swing'' + sin(swing) swing'^2 = tau
//     swing'' - cos(swing) x'' + 10 sin(swing) = 0
#pragma once

#include <memory>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/scene/canonical.hpp"

namespace mixloop {

/// `hangs_freely`: without it a second motor turns the load.
inline std::shared_ptr<const Scene> crane(bool hangs_freely = true) {
  Scene scene = load_scene(parse_document(R"(
name: crane
motors: {trolley: linear, swing: rotary}
coordinates: [x, q]
constraints: {x: trolley, q: swing}
transforms:
  - {from: 0, to: trolley, s: x, alpha: -90 deg}
  - {from: trolley, to: load, theta: q, a: 1 m}
bodies:
  - {frame: trolley, mass: 2 kg}
  - {frame: load, mass: 1 kg}
gravity: [10, 0, 0]
end_effector: {frame: trolley, axes: [z]}
)",
                                          "crane.yaml"));
  scene.independent[1].driven = !hangs_freely;
  scene.canonical = canonical_text(scene);
  return std::make_shared<const Scene>(std::move(scene));
}

}  // namespace mixloop
