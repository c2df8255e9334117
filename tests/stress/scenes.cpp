// SPDX-License-Identifier: MIT
#include "tests/stress/scenes.hpp"

#include <algorithm>

#include "dynamics/assembly/load_scene.hpp"
#include "notation/document.hpp"
#include "tests/oracles/random_mechanism.hpp"

namespace mixloop::stress {

SharedScene shipped_scene(const std::string& name) {
  return std::make_shared<const Scene>(load_scene(std::string(MIXLOOP_SCENES "/") + name + ".yaml"));
}

SharedScene papers_robot() { return shipped_scene("mixed_loop_robot"); }

SharedScene robot_of_parameters() {
  return std::make_shared<const Scene>(load_scene(MIXLOOP_STRESS_FOLDER "/robot_of_parameters.yaml"));
}

SharedScene scene_of(const std::string& text) {
  return std::make_shared<const Scene>(load_scene(parse_document(text, "stress")));
}

SharedScene random_scene(std::uint64_t seed) {
  return scene_of(oracle::RandomMechanism(seed, {.nonlinear = seed % 3 == 0,
                                                 .timed = seed % 4 == 0,
                                                 .loads = seed % 2 == 0,
                                                 .springs = seed % 5 < 2,
                                                 .friction = seed % 7 < 2})
                      .scene_text());
}

SharedScene conservative_scene(std::uint64_t seed) {
  return scene_of(
      oracle::RandomMechanism(seed, {.nonlinear = seed % 3 == 0, .springs = seed % 2 == 0}).scene_text());
}

std::size_t parameter_index(const Scene& scene, const std::string& name) {
  const auto found = std::find_if(scene.parameters.begin(), scene.parameters.end(),
                                  [&](const Scene::Parameter& parameter) { return parameter.name == name; });
  return static_cast<std::size_t>(found - scene.parameters.begin());
}

}  // namespace mixloop::stress
