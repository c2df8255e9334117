// SPDX-License-Identifier: MIT
// The mechanisms of the planner's tests: the paper's robot and some with answers by hand.
#pragma once

#include <memory>
#include <string>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/procedure/procedure.hpp"
#include "planner/path.hpp"
#include "planner/plan.hpp"

namespace mixloop {

inline Model<double> model_of(Scene scene) {
  auto shared = std::make_shared<const Scene>(std::move(scene));
  const std::vector<double> parameters = shared->default_parameters();
  return make_model<double>(shared, parameters);
}

inline Model<double> model_from(const std::string& text) {
  return model_of(load_scene(parse_document(text, "scene.yaml")));
}

/// The paper's robot; `changes` are entries to override.
inline Model<double> paper_robot(const std::vector<std::pair<std::string, std::string>>& changes = {}) {
  NodePtr document = read_document(std::filesystem::path(MIXLOOP_SCENES) / "mixed_loop_robot.yaml");
  for (const auto& [path, value] : changes) document = override_entry(document, path, value);
  return model_of(load_scene(document));
}

/// The same with the other elbow: q5 = -46 deg, q4 = 161 deg at home.
inline Model<double> paper_robot_elbow_down() {
  return paper_robot({{"home", "{psi2: -1280 deg, psi3: -64 deg}"}});
}

/// Two links of 1 m in the plane x, y; motors at the joints, 1 kg at the tip. At home the elbow is at 90 deg.
inline const char* const kPlanarArm = R"(
motors: [a, b]
coordinates: [qa, qb]
constraints: {qa: a, qb: b}
transforms:
  - {from: 0, to: 1, theta: qa, a: 1 m}
  - {from: 1, to: 2, theta: qb, a: 1 m}
bodies: [{frame: 2, mass: 1 kg}]
gravity: [0, -10, 0]
end_effector: {frame: 2, axes: [x, y]}
home: {b: 90 deg}
singularities: {stretched: sin(qb)}
)";

/// The same upright: in the plane x, z.
inline const char* const kUprightArm = R"(
motors: [a, b]
coordinates: [qa, qb]
constraints: {qa: a, qb: b}
transforms:
  - {from: 0, to: base, alpha: 90 deg}
  - {from: base, to: 1, theta: qa, a: 1 m}
  - {from: 1, to: 2, theta: qb, a: 1 m}
bodies: [{frame: 2, mass: 1 kg}]
end_effector: {frame: 2, axes: [x, z]}
home: {b: 90 deg}
)";

/// Three slides along Z, X, Y; the motors of the last two are linear, the first turns a spindle of 10 mm a
/// turn. The slide along X rides on something that moves by itself: 0.1 m sin(2 t).
inline std::string gantry(bool moving) {
  return std::string(R"(
motors: {a: rotary, b: linear, c: linear}
coordinates: [z, x, y]
constraints:
  z: 10 mm * a / (2*pi)
  x: )") +
         (moving ? "b + 0.1 m * sin(2*t/(1 s))" : "b") + R"(
  y: c
transforms:
  - {from: 0, to: 1, s: z, alpha: -90 deg, theta: -90 deg}
  - {from: 1, to: 2, s: x, alpha: -90 deg, theta: 90 deg}
  - {from: 2, to: 3, s: y}
bodies: [{frame: 3, mass: 2 kg}]
gravity: [0, 0, -10]
end_effector: {frame: 3}
)";
}

/// A slide that turns about the origin of the plane x, y; at home it stands out by 1 m along x.
inline const char* const kTurningSlide = R"(
motors: {a: rotary, r: linear}
coordinates: [angle, out]
constraints: {angle: a, out: r}
transforms:
  - {from: 0, to: 1, theta: 90 deg + angle, alpha: 90 deg}
  - {from: 1, to: 2, s: out}
bodies: [{frame: 2, mass: 1 kg}]
end_effector: {frame: 2, axes: [x, y]}
home: {r: 1 m}
)";

inline Path path_from(const std::string& text, const Model<double>& model) {
  return read_path(parse_document(text, "path.yaml"), *model.scene);
}

inline Plan plan_of(const Model<double>& model, const std::string& path,
                    const Plan::Settings& settings = {}) {
  return Plan(model, path_from(path, model), settings);
}

inline const char* const kPaperPath =
    "{line: {from: [0.3, 0.0, 0.8], to: [-0.3, 0.4, 0.3]}, profile: cycloidal, duration: 1 s}";

}  // namespace mixloop
