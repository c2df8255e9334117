// SPDX-License-Identifier: MIT
// A mechanism with answers by hand, for the tests of drives, sensors and faults: a wheel of 1 kg m^2 that a
// rotary motor turns and a slide of 2 kg that a linear one moves, neither knowing of the other.
#pragma once

#include <memory>
#include <string>

#include "dynamics/assembly/load_scene.hpp"
#include "plant/plant.hpp"

namespace mixloop {

/// `weight` sits 1 m off the wheel's axis; `damping` (N m s) brakes the wheel.
inline std::shared_ptr<const Scene> rig(double damping = 0) {
  return std::make_shared<const Scene>(load_scene(parse_document(R"(
name: rig
parameters: {weight: 0 kg, ratio: 1}
motors: {wheel: rotary, slide: linear}
coordinates: [q, x]
constraints: {q: wheel, x: ratio * slide}
transforms:
  - {from: 0, to: 1, theta: q}
  - {from: 0, to: 2, s: x}
bodies:
  - {frame: 1, mass: 1 kg, inertia: {xx: 1 kg m^2, yy: 1 kg m^2, zz: 1 kg m^2}}
  - {frame: 1, mass: weight, center_of_mass: [1 m, 0, 0]}
  - {frame: 2, mass: 2 kg}
loads:
  - {coordinate: q, damping: )" + std::to_string(damping) +
                                                                     R"( N m s/rad}
end_effector: {frame: 1, point: [1 m, 0, 0], axes: [x, y]}
)",
                                                                 "rig.yaml")));
}

inline constexpr double kRigRate = 1000;  // Hz

inline Plant rig_plant(const PlantSettings& settings, double damping = 0) {
  const auto scene = rig(damping);
  return {{equations_of(scene, Evaluation::interpreter, {Purpose::forward_dynamics, Purpose::linearisation},
                        {.friction_factor = settings.faults.change_friction()}),
           scene->default_parameters()},
          settings,
          kRigRate,
          std::vector{0.0, 0.0}};
}

/// Goes on by `ticks` with the wheel's and the slide's command held.
inline void go_on(Plant& plant, int ticks, double wheel, double slide = 0) {
  const double tau[] = {wheel, slide};
  for (int k = 0; k < ticks; ++k) {
    plant.command(tau);
    plant.advance();
  }
}

}  // namespace mixloop
