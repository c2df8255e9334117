// SPDX-License-Identifier: MIT
#include "import/scene_text.hpp"

#include <fmt/format.h>

#include "import/inertia.hpp"
#include "import/rotation.hpp"
#include "import/shapes.hpp"
#include "import/yaml_text.hpp"
#include "notation/utf8.hpp"

namespace mixloop {
namespace {

/// Writes the sections one after the other.
class SceneWriter {
 public:
  SceneWriter(const Robot& robot, const SceneNames& names, const Roles& roles)
      : robot_(robot), names_(names), roles_(roles) {}

  void name() { text_ += fmt::format("name: {}\n", yaml_text(printable_name(robot_.name))); }

  void coordinates() {
    text_ += "\nmotors: " + independent(roles_.motors) + "\n";
    if (!roles_.free.empty()) text_ += "free: " + independent(roles_.free) + "\n";
    if (roles_.mimics.empty()) return;
    std::string list, constraints;
    for (const int j : roles_.mimics) {
      list += (list.empty() ? "" : ", ") + joint_name(j);
      constraints += fmt::format("  {}: {}\n", joint_name(j), constraint(joint(j)));
    }
    text_ += "coordinates: [" + list + "]\nconstraints:\n" + constraints;
  }

  void transforms() {
    text_ += "\ntransforms:\n";
    for (const auto& joint : robot_.joints)
      text_ += fmt::format("  - {{from: {}, to: {}{}{}}}\n", frame(joint.parent), frame(joint.child),
                           pose(joint.origin), motion(joint));
    for (std::size_t i = 0; i < robot_.links.size(); ++i) turned_boxes(static_cast<int>(i));
  }

  void bodies() {
    text_ += "\nbodies:\n";
    const std::vector<bool> moved = moved_links(robot_);
    for (std::size_t i = 0; i < robot_.links.size(); ++i)
      if (moved[i] && robot_.links[i].inertial) body(static_cast<int>(i), *robot_.links[i].inertial);
  }

  void loads() {
    std::string loads;
    for (std::size_t j = 0; j < robot_.joints.size(); ++j)
      if (const auto& one = robot_.joints[j]; one.moves() && one.damping != 0)
        loads += fmt::format("  - {{along: {}, damping: {}}}\n", names_.joints[j],
                             quantity(one.damping, one.slides() ? "N s/m" : "N m s/rad"));
    if (!loads.empty()) text_ += "\nloads:\n" + loads;
  }

  void end(int tip, const std::string& axes, const std::vector<double>& home) {
    text_ += "\ngravity: [0, 0, -9.81 m/s^2]\n";
    text_ += "end_effector: {frame: " + frame(tip);
    for (std::size_t i = 0; i < axes.size(); ++i) text_ += (i == 0 ? ", axes: [" : ", ") + axes.substr(i, 1);
    text_ += axes.empty() ? "}\n" : "]}\n";
    std::string pose;
    std::size_t i = 0;
    for (const auto* joints : {&roles_.motors, &roles_.free})
      for (const int j : *joints) {
        if (home[i] != 0)
          pose += fmt::format("{}{}: {}", pose.empty() ? "" : ", ", joint_name(j), position(j, home[i]));
        ++i;
      }
    if (!pose.empty()) text_ += "home: {" + pose + "}\n";
  }

  void solids() {
    std::string solids;
    for (std::size_t i = 0; i < robot_.links.size(); ++i) {
      int turned = 0;
      for (const auto& shape : solids_of(robot_.links[i]))
        solids += solid(static_cast<int>(i), shape, turned);
    }
    if (!solids.empty()) text_ += "\nsolids:\n" + solids;
  }

  std::string text() && { return broken_lines(text_); }

 private:
  const Robot::Joint& joint(int j) const { return robot_.joints[static_cast<std::size_t>(j)]; }
  const std::string& joint_name(int j) const { return names_.joints[static_cast<std::size_t>(j)]; }
  std::string frame(int link) const {
    return link == 0 ? "0" : yaml_text(names_.frames[static_cast<std::size_t>(link)]);
  }
  std::string position(int j, double value) const {
    return joint(j).slides() ? quantity(value, "m") : angle_text(value);
  }

  /// A list of names, or a mapping where one is linear.
  std::string independent(const std::vector<int>& joints) const {
    std::string names, kinds;
    bool all_turn = true;
    for (const int j : joints) {
      all_turn = all_turn && !joint(j).slides();
      names += (names.empty() ? "" : ", ") + joint_name(j);
      kinds += fmt::format("{}{}: {}", kinds.empty() ? "" : ", ", joint_name(j),
                           joint(j).slides() ? "linear" : "rotary");
    }
    return all_turn ? "[" + names + "]" : "{" + kinds + "}";
  }

  /// multiplier * other + offset, a length of a joint that slides and an angle of one that turns.
  std::string constraint(const Robot::Joint& one) const {
    const Robot::Joint& other = joint(one.mimic->joint);
    std::string text = joint_name(one.mimic->joint);
    const double multiplier = one.mimic->multiplier;
    if (one.slides() && !other.slides())
      text = fmt::format("{} m * {}", multiplier, text);
    else if (multiplier == -1)
      text = "-" + text;
    else if (multiplier != 1)
      text = fmt::format("{} * {}", multiplier, text);
    if (!one.slides() && other.slides()) text += " / 1 m";
    const double offset = one.mimic->offset;
    if (offset == 0) return text;
    const double size = std::abs(offset);
    return text + (offset < 0 ? " - " : " + ") + (one.slides() ? quantity(size, "m") : angle_text(size));
  }

  static std::string pose(const FixedPose& pose) {
    std::string text;
    if (pose.at != Triple{}) text += ", at: " + list_text(pose.at, "m");
    if (pose.is_turned()) text += ", rpy: " + angles_text(pose.rpy);
    return text;
  }

  std::string motion(const Robot::Joint& one) const {
    if (!one.moves()) return one.origin.at == Triple{} && !one.origin.is_turned() ? ", at: [0, 0, 0]" : "";
    const std::string key = one.slides() ? "prismatic" : "revolute";
    return fmt::format(", {}: {}{}", key,
                       names_.joints[static_cast<std::size_t>(&one - robot_.joints.data())], axis(one.axis));
  }

  /// z is what a scene takes unless told.
  static std::string axis(const Triple& axis) {
    if (axis == Triple{0, 0, 1}) return "";
    if (axis == Triple{1, 0, 0}) return ", axis: x";
    if (axis == Triple{0, 1, 0}) return ", axis: y";
    return fmt::format(", axis: [{}, {}, {}]", axis[0], axis[1], axis[2]);
  }

  void body(int link, const Robot::Inertial& inertial) {
    const Eigen::Matrix3d I = inertia_in_link(inertial);
    if (inertial.mass == 0 && I.isZero(0)) return;
    text_ += fmt::format("  - {{name: {}, frame: {}, mass: {}", frame(link), frame(link),
                         quantity(inertial.mass, "kg"));
    if (inertial.origin.at != Triple{})
      text_ += ",\n     center_of_mass: " + list_text(inertial.origin.at, "m");
    if (!I.isZero(0)) {
      text_ += fmt::format(",\n     inertia: {{xx: {}, yy: {}, zz: {}", moment(I(0, 0)), moment(I(1, 1)),
                           moment(I(2, 2)));
      for (const auto& [name, value] :
           {std::pair{"xy", I(0, 1)}, std::pair{"xz", I(0, 2)}, std::pair{"yz", I(1, 2)}})
        if (value != 0) text_ += fmt::format(", {}: {}", name, moment(value));
      text_ += "}";
    }
    text_ += "}\n";
  }
  static std::string moment(double value) { return quantity(value, "kg m^2"); }

  /// A box stands along its frame's axes: one that is turned has a frame of its own.
  void turned_boxes(int link) {
    int turned = 0;
    for (const auto& shape : solids_of(robot_.links[static_cast<std::size_t>(link)]))
      if (is_turned_box(shape))
        text_ += fmt::format("  - {{from: {}, to: {}{}}}\n", frame(link), box_frame(link, ++turned),
                             pose(shape.origin));
  }
  static bool is_turned_box(const Robot::Shape& shape) {
    return shape.kind == Robot::Shape::Kind::box && shape.origin.is_turned();
  }
  std::string box_frame(int link, int number) const {
    return yaml_text(fmt::format("{}/box_{}", names_.frames[static_cast<std::size_t>(link)], number));
  }

  std::string solid(int link, const Robot::Shape& shape, int& turned) const {
    using Kind = Robot::Shape::Kind;
    const auto place = [&](const char* key, const Triple& at) {
      return at == Triple{} && std::string_view(key) == "at"
                 ? ""
                 : fmt::format(", {}: {}", key, list_text(at, "m"));
    };
    if (is_turned_box(shape))
      return fmt::format("  - {{frame: {}, shape: box, size: {}}}\n", box_frame(link, ++turned),
                         list_text(shape.size, "m"));
    const std::string begin = fmt::format("  - {{frame: {}, shape: ", frame(link));
    if (shape.kind == Kind::box)
      return begin + "box, size: " + list_text(shape.size, "m") + place("at", shape.origin.at) + "}\n";
    const std::string radius = "radius: " + quantity(shape.radius, "m");
    if (shape.kind == Kind::sphere) return begin + "sphere, " + radius + place("at", shape.origin.at) + "}\n";
    const Eigen::Vector3d half = rotation_of(shape.origin.rpy).col(2) * (shape.length / 2),
                          at = vector_of(shape.origin.at), from = at - half, to = at + half;
    return begin + "cylinder, " + radius + place("from", {from[0], from[1], from[2]}) +
           place("to", {to[0], to[1], to[2]}) + "}\n";
  }

  const Robot& robot_;
  const SceneNames& names_;
  const Roles& roles_;
  std::string text_;
};

}  // namespace

std::string scene_text(const Robot& robot, const SceneNames& names, const Roles& roles, int tip,
                       const std::string& axes, const std::vector<double>& home) {
  SceneWriter writer(robot, names, roles);
  writer.name();
  writer.coordinates();
  writer.transforms();
  writer.bodies();
  writer.loads();
  writer.end(tip, axes, home);
  writer.solids();
  return std::move(writer).text();
}

}  // namespace mixloop
