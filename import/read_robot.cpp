// SPDX-License-Identifier: MIT
// The model is urdfdom's. Angles are taken from the file, since urdfdom turns them into quaternions, and so
// are places, which it doesn't keep.
#include "import/read_robot.hpp"

#include <fmt/format.h>
#include <urdf_model/model.h>

#include "import/urdf_model.hpp"
#include "import/urdf_tree.hpp"
#include "import/xml_numbers.hpp"
#include "notation/nearest.hpp"
#include "notation/utf8.hpp"

namespace mixloop {
namespace {

using Element = XmlFile::Element;

Triple triple_of(const urdf::Vector3& vector) { return {vector.x, vector.y, vector.z}; }

FixedPose pose_of(const XmlFile& file, const Element& element, const urdf::Pose& pose) {
  return {triple_of(pose.position), triple_in(file, element.FirstChildElement("origin"), "rpy", {})};
}

Robot::Inertial inertial_of(const XmlFile& file, const Element& element, const urdf::Inertial& said) {
  return {.origin = pose_of(file, element, said.origin),
          .mass = said.mass,
          .inertia = {said.ixx, said.iyy, said.izz, said.ixy, said.ixz, said.iyz},
          .place = file.place(element)};
}

Robot::Shape shape_of(const XmlFile& file, const Element& element, const urdf::Pose& origin,
                      const urdf::Geometry& geometry) {
  Robot::Shape shape{.kind = Robot::Shape::Kind::mesh, .origin = pose_of(file, element, origin)};
  if (const auto* box = dynamic_cast<const urdf::Box*>(&geometry)) {
    shape.kind = Robot::Shape::Kind::box;
    shape.size = triple_of(box->dim);
  } else if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(&geometry)) {
    shape.kind = Robot::Shape::Kind::cylinder;
    shape.radius = cylinder->radius;
    shape.length = cylinder->length;
  } else if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(&geometry)) {
    shape.kind = Robot::Shape::Kind::sphere;
    shape.radius = sphere->radius;
  }
  return shape;
}

/// The link's <visual> or <collision> elements are in urdfdom's list one by one.
template <class Parts>
std::vector<Robot::Shape> shapes_of(const XmlFile& file, const Element& link, const char* kind,
                                    const Parts& parts) {
  std::vector<Robot::Shape> shapes;
  std::size_t i = 0;
  for (const Element* element : children_of(link, kind)) {
    if (is_left_out(*element)) continue;
    if (i == parts.size()) break;
    shapes.push_back(shape_of(file, *element, parts[i]->origin, *parts[i]->geometry));
    ++i;
  }
  return shapes;
}

Robot::Link link_of(const XmlFile& file, const Element& element, const urdf::Link& said) {
  Robot::Link link{.name = said.name, .place = file.place(element)};
  if (const Element* inertial = element.FirstChildElement("inertial"); inertial != nullptr && said.inertial)
    link.inertial = inertial_of(file, *inertial, *said.inertial);
  link.visuals = shapes_of(file, element, "visual", said.visual_array);
  link.collisions = shapes_of(file, element, "collision", said.collision_array);
  return link;
}

Robot::Joint::Kind kind_of(const urdf::Joint& joint) {
  using Kind = Robot::Joint::Kind;
  switch (joint.type) {
    case urdf::Joint::REVOLUTE:
      return Kind::revolute;
    case urdf::Joint::CONTINUOUS:
      return Kind::continuous;
    case urdf::Joint::PRISMATIC:
      return Kind::prismatic;
    case urdf::Joint::FLOATING:
      return Kind::floating;
    case urdf::Joint::PLANAR:
      return Kind::planar;
    default:
      return Kind::fixed;
  }
}

void check_limits(const XmlFile& file, const Element& limit, const Robot::Joint& joint) {
  if (joint.limits->lower > joint.limits->upper)
    throw InputError(
        "out_of_range", file.place(limit, "lower"),
        fmt::format("the joint {} has its lower limit, {}, above its upper one, {}; expected the "
                    "other way round",
                    in_quotes(joint.name), joint.limits->lower, joint.limits->upper));
  for (const auto& [name, value] :
       {std::pair{"velocity", joint.limits->velocity}, std::pair{"effort", joint.limits->effort}})
    if (value < 0)
      throw InputError(
          "out_of_range", file.place(limit, name),
          fmt::format("the limit '{}' of the joint {} is {}; expected more than 0, or 0 for none", name,
                      in_quotes(joint.name), value));
}

Robot::Joint joint_of(const XmlFile& file, const Element& element, const urdf::Joint& said) {
  Robot::Joint joint{.name = said.name,
                     .kind = kind_of(said),
                     .origin = pose_of(file, element, said.parent_to_joint_origin_transform),
                     .axis = triple_of(said.axis),
                     .place = file.place(element)};
  if (said.limits)
    joint.limits = {said.limits->lower, said.limits->upper, said.limits->velocity, said.limits->effort};
  if (said.dynamics) joint.damping = said.dynamics->damping, joint.friction = said.dynamics->friction;
  if (joint.damping < 0)
    throw InputError("negative_stiffness", file.place(*element.FirstChildElement("dynamics"), "damping"),
                     fmt::format("the damping of the joint {} is {}, which drives it; expected 0 or more",
                                 in_quotes(joint.name), joint.damping));
  if (joint.moves() && joint.limits) check_limits(file, *element.FirstChildElement("limit"), joint);
  if (joint.moves() && joint.axis == Triple{})
    throw InputError(
        "out_of_range", file.place(*element.FirstChildElement("axis"), "xyz"),
        fmt::format("the axis of the joint {} is 0 0 0; expected a direction", in_quotes(joint.name)));
  return joint;
}

int index_of(const std::vector<Robot::Joint>& joints, const std::string& name) {
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (joints[i].name == name) return static_cast<int>(i);
  return -1;
}

void read_mimic(const XmlFile& file, const Element& element, const urdf::Joint& said, Robot& robot) {
  Robot::Joint& joint = robot.joints[static_cast<std::size_t>(index_of(robot.joints, said.name))];
  const Element& mimic = *element.FirstChildElement("mimic");
  const Place place = file.place(mimic, "joint");
  const int other = index_of(robot.joints, said.mimic->joint_name);
  std::vector<std::string> names;
  for (const auto& one : robot.joints)
    if (one.moves() && one.name != joint.name) names.push_back(one.name);
  if (other < 0)
    throw InputError(
        "undefined_symbol", place,
        fmt::format("the joint {} mimics {}, which there isn't{}", in_quotes(joint.name),
                    in_quotes(said.mimic->joint_name), suggestion(said.mimic->joint_name, names)));
  if (!joint.moves()) return;
  if (!robot.joints[static_cast<std::size_t>(other)].moves())
    throw InputError(
        "undefined_symbol", place,
        fmt::format("the joint {} mimics {}, which doesn't turn or slide{}", in_quotes(joint.name),
                    in_quotes(said.mimic->joint_name), suggestion(said.mimic->joint_name, names)));
  if (said.mimic->multiplier == 0)
    throw InputError(
        "out_of_range", file.place(mimic, "multiplier"),
        fmt::format("the joint {} mimics with a multiplier of 0, so that it never moves; expected "
                    "another, or the type fixed",
                    in_quotes(joint.name)));
  joint.mimic = {other, said.mimic->multiplier, said.mimic->offset, place};
}

void refuse_mimic_circles(const Robot& robot) {
  for (const auto& joint : robot.joints) {
    const Robot::Joint* at = &joint;
    std::string path = in_quotes(joint.name);
    for (std::size_t steps = 0; at->mimic; ++steps) {
      at = &robot.joints[static_cast<std::size_t>(at->mimic->joint)];
      if (path.size() < 400) path += " -> " + in_quotes(at->name);
      if (at == &joint || steps > robot.joints.size())
        throw InputError("cyclic_definition", joint.mimic->place,
                         "joints mimic each other in a circle, " + path + "; expected one that mimics none");
    }
  }
}

}  // namespace

Robot read_robot(const XmlFile& file) {
  const UrdfTree tree = tree_of(file);
  check_numbers(file);
  const auto model = model_of(file);
  Robot robot{.name = model->getName()};
  std::map<std::string, int> indices;
  for (const std::string& name : tree.order) {
    const auto& said = *model->getLink(name);
    indices[name] = static_cast<int>(robot.links.size());
    robot.links.push_back(link_of(file, *tree.links.at(name), said));
    if (!said.parent_joint) continue;
    Robot::Joint joint = joint_of(file, *tree.joint_to.at(name), *said.parent_joint);
    joint.parent = indices.at(said.parent_joint->parent_link_name);
    joint.child = indices.at(name);
    robot.links.back().joint = static_cast<int>(robot.joints.size());
    robot.joints.push_back(std::move(joint));
  }
  for (const std::string& name : tree.order)
    if (const auto& joint = model->getLink(name)->parent_joint; joint && joint->mimic)
      read_mimic(file, *tree.joint_to.at(name), *joint, robot);
  refuse_mimic_circles(robot);
  return robot;
}

}  // namespace mixloop
