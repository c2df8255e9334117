// SPDX-License-Identifier: MIT
#include "import/urdf_tree.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "notation/nearest.hpp"
#include "notation/utf8.hpp"

namespace mixloop {
namespace {

using Element = XmlFile::Element;
using Elements = std::map<std::string, const Element*>;

constexpr std::size_t kMostLinks = 1000;  ///< a scene's frames
constexpr std::array kJointTypes = {"fixed", "revolute", "continuous", "prismatic", "floating", "planar"};

std::string line_text(const XmlFile& file, const Element& element) {
  return fmt::format("line {}", file.place(element).line);
}

void refuse_other_roots(const XmlFile& file) {
  const Element& root = file.root();
  const std::string_view name = root.Name();
  if (name != "robot")
    throw InputError("not_urdf", file.place(root),
                     fmt::format("found <{}>; expected a URDF, <robot name=\"...\">{}", printable_name(name),
                                 name == "sdf" || name == "mujoco" ? ": write the robot as one first" : ""));
  for_each_element(root, [&](const Element& element) {
    if (std::string_view(element.Name()).starts_with("xacro:"))
      throw InputError("not_urdf", file.place(element),
                       fmt::format("found <{}>, a macro; expected a URDF: expand it first, "
                                   "xacro ROBOT.urdf.xacro > ROBOT.urdf",
                                   printable_name(element.Name())));
  });
  needed(file, root, "name");
}

Elements by_name(const XmlFile& file, const char* kind) {
  Elements all;
  for (const Element* element : children_of(file.root(), kind)) {
    const std::string name = needed(file, *element, "name");
    const auto [known, is_new] = all.emplace(name, element);
    if (!is_new)
      throw InputError("doubly_defined", file.place(*element, "name"),
                       fmt::format("a second {} {}; the first stands at {}", kind, in_quotes(name),
                                   line_text(file, *known->second)));
    if (all.size() > kMostLinks)
      throw InputError("too_large", file.place(*element),
                       fmt::format("more than {} {}s; expected fewer", kMostLinks, kind));
  }
  return all;
}

std::vector<std::string> names_of(const Elements& elements) {
  std::vector<std::string> names;
  for (const auto& [name, element] : elements) names.push_back(name);
  return names;
}

/// The link that <parent link="..."/> or <child .../> of a joint names.
std::string end_link(const XmlFile& file, const Element& joint, const char* end, const Elements& links) {
  const Element* element = joint.FirstChildElement(end);
  const std::string name = needed(file, joint, "name");
  if (element == nullptr)
    throw InputError("missing_key", file.place(joint),
                     fmt::format("the joint {} lacks <{} link=\"...\"/>", in_quotes(name), end));
  const std::string link = needed(file, *element, "link");
  if (!links.contains(link))
    throw InputError("undefined_symbol", file.place(*element, "link"),
                     fmt::format("the {} of the joint {} is the link {}, which there isn't{}", end,
                                 in_quotes(name), in_quotes(link), suggestion(link, names_of(links))));
  return link;
}

void check_type(const XmlFile& file, const Element& joint) {
  const std::string type = needed(file, joint, "type");
  const std::vector<std::string> known(kJointTypes.begin(), kJointTypes.end());
  if (std::find(known.begin(), known.end(), type) == known.end())
    throw InputError("unknown_value", file.place(joint, "type"),
                     "the type of a joint is " + in_quotes(type) + suggestion(type, known));
  if ((type == "revolute" || type == "prismatic") && joint.FirstChildElement("limit") == nullptr)
    throw InputError(
        "missing_key", file.place(joint),
        fmt::format("the {} joint {} lacks <limit>; expected lower, upper, effort and velocity{}", type,
                    in_quotes(needed(file, joint, "name")),
                    type == "revolute" ? ", or the type continuous" : ""));
}

void refuse_second_parent(const XmlFile& file, const std::string& link, const Element& first,
                          const Element& second) {
  throw InputError(
      "not_a_tree", file.place(second),
      fmt::format("the link {} is the child of two joints, {} at {} and {} here; expected a tree: "
                  "leave one out, and write what it holds as a closure of the scene",
                  in_quotes(link), in_quotes(needed(file, first, "name")), line_text(file, first),
                  in_quotes(needed(file, second, "name"))));
}

/// The links in a circle above one that has no root.
std::string circle_above(const XmlFile& file, const UrdfTree& tree, std::string link) {
  std::vector<std::string> path;
  while (std::find(path.begin(), path.end(), link) == path.end()) {
    path.push_back(link);
    link = needed(file, *tree.joint_to.at(link)->FirstChildElement("parent"), "link");
  }
  path.erase(path.begin(), std::find(path.begin(), path.end(), link));
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(path.size(), 8); ++i) text += in_quotes(path[i]) + " <- ";
  return text + (path.size() > 8 ? "..." : in_quotes(link));
}

/// The links without a joint that leads to them, in the file's order.
std::vector<std::string> roots_of(const XmlFile& file, const UrdfTree& tree) {
  std::vector<std::string> roots;
  for (const Element* link : children_of(file.root(), "link"))
    if (const std::string name = needed(file, *link, "name"); !tree.joint_to.contains(name))
      roots.push_back(name);
  return roots;
}

void order_links(const XmlFile& file, UrdfTree& tree) {
  std::map<std::string, std::vector<std::string>> children;
  for (const Element* joint : children_of(file.root(), "joint"))
    children[end_link(file, *joint, "parent", tree.links)].push_back(
        end_link(file, *joint, "child", tree.links));
  const std::vector<std::string> roots = roots_of(file, tree);
  if (roots.size() > 1)
    throw InputError(
        "not_a_tree", file.place(*tree.links.at(roots[1])),
        fmt::format("{} links have no parent, {} at {} and {} here; expected one root: join them, "
                    "by a fixed joint where nothing moves between them",
                    roots.size(), in_quotes(roots[0]), line_text(file, *tree.links.at(roots[0])),
                    in_quotes(roots[1])));
  std::vector<std::string> pending = roots;
  while (!pending.empty()) {  // depth first, so that a branch stands together
    tree.order.push_back(pending.back());
    pending.pop_back();
    const auto& next = children[tree.order.back()];
    pending.insert(pending.end(), next.rbegin(), next.rend());
  }
  if (tree.order.size() == tree.links.size()) return;
  for (const auto& [name, link] : tree.links)
    if (std::find(tree.order.begin(), tree.order.end(), name) == tree.order.end())
      throw InputError("not_a_tree", file.place(*link),
                       "joints lead round in a circle, " + circle_above(file, tree, name) +
                           "; expected a tree that begins at one link");
}

}  // namespace

std::string needed(const XmlFile& file, const XmlFile::Element& element, const char* attribute) {
  const auto value = attribute_of(element, attribute);
  if (value && !value->empty()) return *value;
  throw InputError("missing_key", file.place(element),
                   fmt::format("<{}> lacks '{}'", printable_name(element.Name()), attribute));
}

UrdfTree tree_of(const XmlFile& file) {
  refuse_other_roots(file);
  UrdfTree tree{.links = by_name(file, "link"), .joints = by_name(file, "joint")};
  if (tree.links.empty())
    throw InputError("missing_key", file.place(file.root()),
                     "the robot has no <link>; expected some, and joints");
  for (const Element* joint : children_of(file.root(), "joint")) {
    check_type(file, *joint);
    end_link(file, *joint, "parent", tree.links);
    const std::string child = end_link(file, *joint, "child", tree.links);
    const auto [known, is_new] = tree.joint_to.emplace(child, joint);
    if (!is_new) refuse_second_parent(file, child, *known->second, *joint);
  }
  order_links(file, tree);
  return tree;
}

}  // namespace mixloop
