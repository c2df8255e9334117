// SPDX-License-Identifier: MIT
#include "dynamics/assembly/load_scene.hpp"

#include "dynamics/assembly/assemble.hpp"
#include "dynamics/scene/canonical.hpp"
#include "dynamics/scene/continuous_angles.hpp"
#include "dynamics/scene/read_scene.hpp"
#include "notation/value.hpp"

namespace mixloop {
namespace {

/// Whether an arc tangent has jumped is looked at along a path by formulas alone: those of solved coordinates
/// it would not see.
void refuse_arc_tangents_of_solved(const Scene& scene) {
  if (!scene.is_closed()) return;
  const Symbols symbols(scene);
  std::vector<bool> solved;
  for (const auto& coordinate : scene.coordinates) solved.push_back(coordinate.is_solved());
  const auto rests_on_them = [&](const Formula& formula) {
    return depends_on(formula, [&](int symbol) {
      return symbols.is_q(symbol) && solved[static_cast<std::size_t>(symbol - symbols.q0)];
    });
  };
  for (int j : scene.evaluation_order)
    solved[static_cast<std::size_t>(j)] =
        rests_on_them(scene.coordinates[static_cast<std::size_t>(j)].constraint);
  for (const CountedAngle& angle : counted_angles(scene)) {
    const Formula& formula = angle.load >= 0
                                 ? scene.along_loads[static_cast<std::size_t>(angle.load)].along
                                 : scene.coordinates[static_cast<std::size_t>(angle.coordinate)].constraint;
    if (rests_on_them(formula))
      throw InputError("counted_angle", formula.place,
                       "an arc tangent of coordinates that are solved from closures, whose value counts (a "
                       "load, a slide or a gear reads it), may jump by a turn unseen; expected a closure "
                       "'zero' that solves for the angle, or its sine and cosine alone");
  }
}

}  // namespace

Scene load_scene(const NodePtr& document) {
  Scene scene = read_scene(document);
  assemble(scene);
  check_physical(scene, scene.default_parameters());
  refuse_arc_tangents_of_solved(scene);
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
