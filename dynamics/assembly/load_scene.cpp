// SPDX-License-Identifier: MIT
#include "dynamics/assembly/load_scene.hpp"

#include "dynamics/assembly/assemble.hpp"
#include "dynamics/scene/canonical.hpp"
#include "dynamics/scene/continuous_angles.hpp"
#include "dynamics/scene/read_scene.hpp"
#include "notation/value.hpp"

namespace mixloop {

Scene load_scene(const NodePtr& document) {
  Scene scene = read_scene(document);
  assemble(scene);
  check_physical(scene, scene.default_parameters());
  turn_cuts_away_from_home(scene);
  scene.warnings = physical_warnings(scene);
  scene.canonical = canonical_text(scene);
  return scene;
}

Scene load_scene(const std::filesystem::path& path) { return load_scene(read_document(path)); }

std::vector<double> parameter_values(const Scene& scene, const NodePtr& overrides,
                                     std::vector<double> values) {
  if (!overrides || overrides->kind == Node::Kind::empty) return values;
  std::vector<std::string> names;
  for (const auto& parameter : scene.parameters) names.push_back(parameter.name);
  const Mapping entry(overrides, "the parameters", names);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (const NodePtr value = entry.find(names[i]))
      values[i] = number_of(*value, scene.parameters[i].dimension, "the parameter '" + names[i] + "'");
  try {
    check_physical(scene, values);
    check_assembled(scene, values);
  } catch (const InputError& error) {
    throw InputError(error.code, overrides->place, "with these parameters, " + error.message);
  }
  return values;
}

}  // namespace mixloop
