// SPDX-License-Identifier: MIT
#include "dynamics/scene/canonical.hpp"

#include <fmt/format.h>

#include <span>

#include "notation/words.hpp"

namespace mixloop {
namespace {

void add(std::string& text, const Formula& formula) {
  for (const auto& node : formula.nodes)
    text += fmt::format("{},{},{},{:a},{},{};", static_cast<int>(node.op), node.left, node.right, node.value,
                        node.symbol, node.exponent);
  text += '\n';
}

void add(std::string& text, std::span<const Formula> formulas) {
  for (const auto& formula : formulas) add(text, formula);
}

void add_closures(std::string& text, const Scene& scene) {
  for (const auto& closure : scene.closures) {
    text += fmt::format("closure {} {} {} {} {} {:a} {}\n", static_cast<int>(closure.kind), closure.frames[0],
                        closure.frames[1], closure.in, closure.least_axis, closure.home_length,
                        joined(closure.axes, " "));
    for (const auto& vector : closure.vectors) add(text, vector);
    add(text, closure.value);
  }
  for (const auto& coordinate : scene.coordinates)
    text += fmt::format("{:a} {} ", coordinate.home, coordinate.constraint.dimension.same_powers(kLength));
  for (const auto& block : scene.blocks) {
    text += fmt::format("\nblock {} {}", joined(block.unknowns, " "), block.by_newton);
    if (!block.cut.empty()) text += fmt::format(" cut {}", joined(block.cut, " "));
    for (const auto& row : block.rows) text += fmt::format(" {}.{}", row.closure, row.row);
  }
  text += fmt::format("\nstarted {}\n", joined(scene.started, " "));
}

}  // namespace

std::string canonical_text(const Scene& scene) {
  std::string text =
      fmt::format("mixloop scene 1\n{} {} {}\n", scene.parameters.size(), scene.n(), scene.m());
  for (const auto& coordinate : scene.independent) {
    if (!coordinate.driven) text += "free ";
    text += coordinate.linear ? "linear\n" : "rotary\n";
  }
  for (const auto& coordinate : scene.coordinates) add(text, coordinate.constraint);
  for (const auto& transform : scene.transforms) {
    text += fmt::format("transform {} {} {}\n", transform.parent, transform.coordinate.value_or(-1),
                        transform.prismatic);
    for (const auto* formula : {&transform.theta, &transform.s, &transform.a, &transform.alpha})
      add(text, *formula);
  }
  for (const auto& body : scene.bodies) {
    text += fmt::format("body {}\n", body.frame);
    add(text, body.mass);
    add(text, body.center_of_mass);
    add(text, body.inertia);
  }
  for (const auto& load : scene.loads) {
    text += fmt::format("load {}\n", load.frame);
    add(text, load.point);
    add(text, load.force);
    add(text, load.moment);
  }
  for (const auto& load : scene.coordinate_loads) {
    text += fmt::format("coordinate load {}\n", load.coordinate);
    for (const auto* formula : {&load.stiffness, &load.rest, &load.damping}) add(text, *formula);
  }
  for (const auto& load : scene.along_loads) {
    text += "along load\n";
    for (const auto* formula : {&load.along, &load.law.stiffness, &load.law.rest, &load.law.damping})
      add(text, *formula);
  }
  for (const auto& load : scene.between_loads) {
    text += fmt::format("between load {} {}\n", load.ends[0].frame, load.ends[1].frame);
    for (const auto& end : load.ends) add(text, end.point);
    for (const auto* formula : {&load.law.stiffness, &load.law.rest, &load.law.damping}) add(text, *formula);
  }
  if (scene.friction_factor) text += "friction factor\n";
  if (scene.from_starts) text += fmt::format("from starts, acts along {}\n", joined(scene.acts_along, " "));
  if (scene.is_closed()) add_closures(text, scene);
  text += "gravity\n";
  add(text, scene.gravity);
  if (scene.end_effector.named) {
    text +=
        fmt::format("end effector {} {}\n", scene.end_effector.frame, joined(scene.end_effector.axes, " "));
    add(text, scene.end_effector.point);
    if (!scene.end_effector.turns.empty())
      text += fmt::format("turns about {}\n", joined(scene.end_effector.turns, " "));
    if (const auto& direction = scene.end_effector.direction)
      text += fmt::format("points along {:a} {:a} {:a}\n", (*direction)[0], (*direction)[1], (*direction)[2]);
  } else {
    text += "no end effector\n";
  }
  for (const double psi : scene.home) text += fmt::format("{:a} ", psi);
  for (const auto& singularity : scene.singularities) add(text, singularity.measure);
  return text;
}

}  // namespace mixloop
