// SPDX-License-Identifier: MIT
#include "import/left_behind.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "import/robot.hpp"
#include "import/shapes.hpp"
#include "import/xml_file.hpp"
#include "notation/utf8.hpp"

namespace mixloop {
namespace {

using Element = XmlFile::Element;

/// What the reader takes of each element; other children are left behind.
const std::map<std::string, std::set<std::string>, std::less<>>& known_children() {
  static const std::map<std::string, std::set<std::string>, std::less<>> known = {
      {"robot", {"link", "joint"}},
      {"link", {"inertial", "visual", "collision"}},
      {"joint", {"parent", "child", "origin", "axis", "limit", "dynamics", "mimic"}},
      {"inertial", {"origin", "mass", "inertia"}},
      {"visual", {"origin", "geometry"}},
      {"collision", {"origin", "geometry"}},
      {"geometry", {"box", "cylinder", "sphere", "mesh"}}};
  return known;
}

/// The name of the element, or of what it refers to, or of the nearest element around it that has any.
std::string whose(const Element& element) {
  for (const tinyxml2::XMLNode* at = &element; at != nullptr; at = at->Parent())
    for (const char* attribute : {"name", "reference"})
      if (at->ToElement() != nullptr && at->ToElement()->Attribute(attribute) != nullptr)
        return at->ToElement()->Attribute(attribute);
  return "without a name";
}

/// All below an element that is left behind goes with it.
void list_unknown(const XmlFile& file, const Element& element, LeftBehind& left) {
  const auto known = known_children().find(element.Name());
  if (known == known_children().end()) return;
  for (const Element* child : children_of(element)) {
    if (known->second.contains(child->Name()))
      list_unknown(file, *child, left);
    else
      left.add(fmt::format("<{}>", printable_name(child->Name())), whose(*child), file.place(*child));
  }
}

void list_joints(const Robot& robot, LeftBehind& left) {
  using Kind = Robot::Joint::Kind;
  for (const auto& joint : robot.joints) {
    const auto add = [&](const char* what) { left.add(what, joint.name, joint.place); };
    if (joint.kind == Kind::floating) add("floating joints, held fixed");
    if (joint.kind == Kind::planar) add("planar joints, held fixed");
    if (joint.moves() && joint.friction != 0)
      add("Coulomb friction of the joints (plant.actuators has one for motors)");
  }
}

void list_shapes(const Robot& robot, LeftBehind& left) {
  for (const auto& link : robot.links) {
    const auto add = [&](const char* what) { left.add(what, link.name, link.place); };
    const auto has = [](const std::vector<Robot::Shape>& shapes, auto&& is) {
      return std::any_of(shapes.begin(), shapes.end(), is);
    };
    const auto is_mesh = [](const Robot::Shape& shape) { return shape.kind == Robot::Shape::Kind::mesh; };
    const auto is_flat = [&](const Robot::Shape& shape) { return !is_mesh(shape) && !is_solid(shape); };
    if (has(link.visuals, is_mesh)) add("meshes of the links");
    if (has(link.visuals, is_flat) || has(link.collisions, is_flat))
      add("shapes without an extent, of the links");
    if (has(link.collisions, is_mesh)) add("collision meshes of the links");
    if (has(link.visuals, is_solid) && has(link.collisions, is_solid))
      add("collision shapes of the links, whose visual shapes are drawn");
  }
}

}  // namespace

void LeftBehind::add(const std::string& what, const std::string& name, const Place& place) {
  const auto [known, is_new] = index_.emplace(what, kinds_.size());
  if (is_new) kinds_.push_back({what, {}, place});
  if (listed_.emplace(known->second, name).second) kinds_[known->second].names.push_back(name);
}

std::string text_of(const LeftBehind::Kind& kind) {
  std::string text = kind.what + ":";
  for (std::size_t i = 0; i < kind.names.size(); ++i)
    text += (i == 0 ? " " : ", ") + printable_name(kind.names[i]);
  return text;
}

void list_left_behind(const XmlFile& file, const Robot& robot, LeftBehind& left) {
  list_joints(robot, left);
  list_shapes(robot, left);
  list_unknown(file, file.root(), left);
}

}  // namespace mixloop
