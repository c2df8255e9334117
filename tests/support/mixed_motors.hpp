// SPDX-License-Identifier: MIT
// A motor that turns an arm in the plane and one that slides 1 kg along it.
#pragma once

#include <string>

namespace mixloop {

inline const std::string kMixedMotorsScene = R"(name: slide and turn
motors: {slide: linear, turn: rotary}
coordinates: [r, q]
constraints: {r: slide, q: turn}
transforms:
  - {from: 0, to: arm, theta: q, alpha: 90 deg}
  - {from: arm, to: head, s: r}
bodies:
  - {frame: head, mass: 1 kg}
end_effector: {frame: head, axes: [x, y]}
home: {slide: 0.5 m, turn: 90 deg}
)";

/// Beside it as `scene.yaml`.
inline const std::string kMixedMotorsExperiment = R"(scene: scene.yaml
path: {line: {from: [0.5, 0], to: [0.4, 0.3]}, duration: 0.2 s}
controller: {law: computed_torque, kp: [5000 N/m, 500 N m/rad], kv: [100 N s/m, 10 N m s/rad]}
)";

}  // namespace mixloop
