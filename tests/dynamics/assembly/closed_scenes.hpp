// SPDX-License-Identifier: MIT
// Scenes whose chains close, as texts.
#pragma once

#include <string>

#include "dynamics/assembly/load_scene.hpp"

namespace mixloop {

inline Scene loaded(const std::string& text) { return load_scene(parse_document(text, "scene.yaml")); }

inline const std::string kLinks = R"yaml(
bodies:
  - {frame: crank, mass: 1 kg, center_of_mass: [-a/2, 0, 0], inertia: {xx: 0, yy: 0.01, zz: 0.01}}
  - {frame: coupler, mass: 2 kg, center_of_mass: [-b/2, 0, 0], inertia: {xx: 0, yy: 0.05, zz: 0.05}}
  - {frame: rocker, mass: 1.5 kg, center_of_mass: [-c/2, 0, 0], inertia: {xx: 0, yy: 0.04, zz: 0.04}}
gravity: [0, -9.81, 0]
end_effector: {frame: coupler, axes: [x]}
)yaml";

/// A crank of 0.3 m, a coupler of 0.9 m and a rocker of 0.8 m on a ground of 1 m; lengths are parameters.
inline std::string four_bar(const std::string& home = "crank: 60 deg, q2: -40 deg, q3: 80 deg") {
  return R"yaml(
name: four-bar
constants: {g: 1 m, a: 0.3 m, b: 0.9 m, c: 0.8 m}
motors: [crank]
coordinates: [q1, q2, q3]
constraints: {q1: crank}
transforms:
  - {from: 0, to: crank, theta: q1, a: a}
  - {from: crank, to: coupler, theta: q2, a: b}
  - {from: 0, to: pivot, a: g}
  - {from: pivot, to: rocker, theta: q3, a: c}
closures:
  - {name: loop, coincide: [{frame: coupler}, {frame: rocker}]}
home: {)yaml" +
         home + "}\n" + kLinks;
}

/// As in the paper's pantograph: bars of equal length, two and two.
inline const std::string kParallelogram = R"yaml(
name: parallelogram
constants: {a: 0.3 m, b: 0.9 m, c: 0.3 m}
motors: [psi]
coordinates: [crank_angle, q2, q3]
constraints: {crank_angle: psi/2 + 20 deg}
transforms:
  - {from: 0, to: crank, theta: crank_angle, a: a}
  - {from: crank, to: coupler, theta: q2, a: b}
  - {from: 0, to: pivot, a: b}
  - {from: pivot, to: rocker, theta: q3, a: c}
closures:
  - {coincide: [{frame: coupler}, {frame: rocker}], axes: [x, y]}
home: {psi: 60 deg, q2: -50 deg, q3: 50 deg}
)yaml" + kLinks;

/// The rod's end in a ball joint on the crank, on a slider's universal joint: no closed form.
inline const std::string kSpatialSliderCrank = R"yaml(
name: spatial slider-crank
constants: {crank: 0.08 m, rod: 0.3 m, A_y: 0.1 m, A_z: 0.12 m}
motors: [theta]
coordinates: [turn, slide, roll, tilt]
constraints: {turn: theta}
transforms:
  - {from: 0, to: rail, theta: 90 deg, alpha: 90 deg}
  - {from: rail, to: below A, a: A_y}
  - {from: below A, to: A, theta: 90 deg, a: A_z}
  - {from: A, to: crank, theta: turn, a: crank}
  - {from: rail, to: slider, s: slide}
  - {from: slider, to: cross, theta: roll, alpha: 90 deg}
  - {from: cross, to: rod, theta: tilt, a: rod}
closures:
  - {name: ball, coincide: [{frame: crank}, {frame: rod}]}
bodies:
  - {frame: crank, mass: 0.12 kg, center_of_mass: [-crank/2, 0, 0], inertia: {xx: 0, yy: 1e-4, zz: 1e-4}}
  - {frame: rod, mass: 0.5 kg, center_of_mass: [-rod/2, 0, 0], inertia: {xx: 4e-4, yy: 4e-3, zz: 4e-3}}
  - {frame: slider, mass: 2 kg}
gravity: [0, 0, -9.81]
end_effector: {frame: slider, axes: [x]}
home: {slide: 0.2 m, roll: 60 deg, tilt: -40 deg}
)yaml";

/// A platform on three rods, one of which a crank drives: no dyads, but the rods to the ground turn alone.
inline const std::string kOnThreeRods = R"yaml(
name: platform on three rods
motors: [crank]
coordinates: [rod1, turn, rod2, rod3]
transforms:
  - {from: 0, to: A, revolute: crank}
  - {from: A, to: B, at: [0.2 m, 0, 0], revolute: rod1}
  - {from: B, to: platform, at: [0.6 m, 0, 0], revolute: turn}
  - {from: 0, to: C, at: [1 m, 0, 0], revolute: rod2}
  - {from: 0, to: D, at: [0.3 m, 1.1 m, 0], revolute: rod3}
closures:
  - {name: rod 2, coincide: [{frame: C, point: [0.3 m, 0, 0]}, {frame: platform, point: [0.3 m, 0, 0]}], axes: [x, y]}
  - {name: rod 3, coincide: [{frame: platform, point: [0.1 m, 0.25 m, 0]}, {frame: D, point: [0.7 m, 0, 0]}]}
bodies:
  - {frame: A, mass: 1 kg, center_of_mass: [0.1, 0, 0], inertia: {xx: 0, yy: 0.01, zz: 0.01}}
  - {frame: B, mass: 2 kg, center_of_mass: [0.3, 0, 0], inertia: {xx: 0, yy: 0.05, zz: 0.05}}
  - {frame: C, mass: 1.5 kg, center_of_mass: [0.15, 0, 0], inertia: {xx: 0, yy: 0.02, zz: 0.02}}
  - {frame: D, mass: 1.5 kg, center_of_mass: [0.35, 0, 0], inertia: {xx: 0, yy: 0.04, zz: 0.04}}
  - {frame: platform, mass: 3 kg, center_of_mass: [0.15, 0.1, 0], inertia: {xx: 0.03, yy: 0.03, zz: 0.05}}
gravity: [0, -9.81, 0]
end_effector: {frame: platform, axes: [x]}
home: {crank: 70 deg, rod1: -60 deg, turn: -10 deg, rod2: 98 deg, rod3: -51 deg}
)yaml";

/// A text with one of its parts, which must occur, as another.
inline std::string with(std::string text, const std::string& part, const std::string& other) {
  const auto at = text.find(part);
  if (at == std::string::npos) throw std::logic_error("no '" + part + "' in the scene");
  return text.replace(at, part.size(), other);
}

}  // namespace mixloop
