// SPDX-License-Identifier: MIT
#include "dynamics/scene/load_scene.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>

#include "dynamics/scene/canonical.hpp"
#include "dynamics/scene/definitions.hpp"
#include "notation/nearest.hpp"
#include "notation/value.hpp"

namespace mixloop {
namespace {

using Names = std::array<const char*, 3>;
constexpr Names kAxes = {"x", "y", "z"};

/// Reads one scene, section by section, in the order in which their names depend on each other.
class SceneReader {
 public:
  explicit SceneReader(const NodePtr& document)
      : root_(document, "the scene",
              {"name", "constants", "parameters", "motors", "coordinates", "constraints", "transforms", "bodies", "loads",
               "gravity", "end_effector", "home", "singularities"}) {}

  Scene read() {
    read_name();
    read_parameters();
    read_constants();
    read_motors();
    read_constraints();
    read_transforms();
    read_bodies();
    read_loads();
    read_gravity();
    read_end_effector();
    read_home();
    read_singularities();
    check_physical(scene_, scene_.default_parameters());
    warn_of_triangles();
    scene_.canonical = canonical_text(scene_);
    return std::move(scene_);
  }

 private:
  Formula formula(const Node& node, const Dimension& wanted, const std::string& what, const Scope& scope) const {
    Formula result = parse_formula(node, what, scope);
    require_dimension(result, wanted, what);
    return result;
  }
  Formula number(const Node& node, const Dimension& wanted, const std::string& what) const { return formula(node, wanted, what, fixed_); }

  std::array<Formula, 3> vector(const NodePtr& node, const Dimension& wanted, const std::string& what, const Scope& scope) const {
    if (!node) return {constant_formula(0, wanted), constant_formula(0, wanted), constant_formula(0, wanted)};
    const auto items = items_of(node, what);
    if (items.size() != 3) throw InputError("wrong_size", node->place, fmt::format("{} has {} values; expected x, y, z", what, items.size()));
    return {formula(*items[0], wanted, what, scope), formula(*items[1], wanted, what, scope), formula(*items[2], wanted, what, scope)};
  }

  void read_name() {
    const NodePtr node = root_.find("name");
    scene_.name = node ? text_of(*node, "the scene's name") : std::filesystem::path(root_.node().place.file).stem().string();
  }

  const Node* section(const char* key) const {
    const NodePtr node = root_.find(key);
    if (!node || node->kind == Node::Kind::kEmpty) return nullptr;
    if (node->kind != Node::Kind::kMapping)
      throw InputError("wrong_kind", node->place, "found " + describe(*node) + "; expected " + key + " as name: value");
    return node.get();
  }

  void read_parameters() {
    const Node* node = section("parameters");
    if (!node) return;
    for (const auto& entry : node->entries) {
      const Formula value = number(*entry.value, kOpen, "the parameter");
      if (!value.is_constant()) throw InputError("invalid_formula", entry.value->place, "a parameter's default is a number");
      fixed_.define_symbol(entry.key, Symbols::kParameter0 + static_cast<int>(scene_.parameters.size()), value.dimension, entry.place);
      scene_.parameters.push_back({entry.key, value.dimension, value.constant(), entry.place});
    }
  }

  void read_constants() {
    if (const Node* node = section("constants"))
      define_in_order(*node, "constants", [&](const Node::Entry& entry) {
        fixed_.define_formula(entry.key, parse_formula(*entry.value, "a formula", fixed_), entry.place);
      });
  }

  void read_motors() {
    const NodePtr node = root_.at("motors");
    moving_ = fixed_;
    moving_.define_symbol("t", Symbols::kTime, kTime, {});
    const Symbols symbols(static_cast<int>(scene_.parameters.size()), 0);
    const auto add = [&](const std::string& name, bool linear, const Place& place) {
      moving_.define_symbol(name, symbols.psi0 + scene_.n(), linear ? kLength : kPure, place);
      scene_.motors.push_back({name, linear});
    };
    if (node->kind == Node::Kind::kMapping) {
      for (const auto& entry : node->entries) add(entry.key, word_of(*entry.value, {"rotary", "linear"}, "the motor's kind") == 1, entry.place);
    } else {
      for (const auto& item : items_of(node, "the motors' names")) add(text_of(*item, "a motor's name"), false, item->place);
    }
    if (scene_.motors.empty()) throw InputError("missing_key", node->place, "no motor; expected at least one independent coordinate");
    if (scene_.motors.size() > 64) throw InputError("too_large", node->place, "more than 64 motors");
  }

  void read_constraints() {
    const NodePtr list = root_.at("coordinates");
    const NodePtr constraints = root_.at("constraints");
    if (constraints->kind != Node::Kind::kMapping)
      throw InputError("wrong_kind", constraints->place, "found " + describe(*constraints) + "; expected constraints as coordinate: equation");
    const Symbols symbols(scene_);
    for (const auto& item : items_of(list, "the coordinates' names")) {
      const std::string& name = text_of(*item, "a coordinate's name");
      if (coordinate_index_.contains(name)) throw InputError("doubly_defined", item->place, "the coordinate '" + name + "' is listed twice");
      coordinate_index_[name] = scene_.m();
      scene_.coordinates.push_back({name, {}});
      check_name(name, item->place);
      if (std::none_of(constraints->entries.begin(), constraints->entries.end(), [&](const auto& entry) { return entry.key == name; }))
        throw InputError("missing_constraint", item->place, "no constraint gives the coordinate '" + name + "'; expected an entry '" + name + ": ...' under constraints");
    }
    if (scene_.coordinates.size() > 256) throw InputError("too_large", list->place, "more than 256 coordinates");
    for (const auto& entry : constraints->entries)
      if (!coordinate_index_.contains(entry.key))
        throw InputError("undefined_symbol", entry.place, "a constraint for '" + entry.key + "', which is no coordinate" + suggestion(entry.key, coordinate_names()));
    define_in_order(*constraints, "coordinates", [&](const Node::Entry& entry) {
      const int index = coordinate_index_.at(entry.key);
      Formula equation = parse_formula(*entry.value, "a formula", moving_);
      const Dimension dimension = equation.dimension.open ? kPure : equation.dimension;
      if (!dimension.pure() && !dimension.same_powers(kLength))
        throw InputError("wrong_dimension", equation.place, "the coordinate '" + entry.key + "' is " + to_string(dimension) + "; expected an angle or a length");
      scene_.coordinates[static_cast<std::size_t>(index)].constraint = std::move(equation);
      scene_.evaluation_order.push_back(index);
      moving_.define_symbol(entry.key, symbols.q0 + index, dimension, entry.place);
    });
  }

  std::vector<std::string> coordinate_names() const {
    std::vector<std::string> names;
    for (const auto& coordinate : scene_.coordinates) names.push_back(coordinate.name);
    return names;
  }

  /// Frames are made by transforms; they are put in order so that parents come first.
  void read_transforms() {
    const auto items = items_of(root_.at("transforms"), "the transforms");
    std::vector<Mapping> pending;
    std::map<std::string, Place> made;
    for (const auto& item : items) {
      pending.emplace_back(item, "a transform", std::vector<std::string>{"from", "to", "theta", "s", "a", "alpha"});
      const NodePtr to = pending.back().at("to");
      const std::string& name = text_of(*to, "a frame's name");
      if (name == "0") throw InputError("doubly_defined", to->place, "a transform to the ground frame '0'");
      if (const auto [known, is_new] = made.emplace(name, to->place); !is_new)
        throw InputError("doubly_defined", to->place, fmt::format("two transforms make the frame '{}', the first at line {}", name, known->second.line));
    }
    scene_.frames = {"0"};
    frame_index_["0"] = 0;
    while (!pending.empty()) {
      const auto next = std::find_if(pending.begin(), pending.end(), [&](const Mapping& entry) { return frame_index_.contains(text_of(*entry.at("from"), "a frame's name")); });
      if (next == pending.end()) {
        const NodePtr from = pending.front().at("from");
        throw InputError("broken_path", from->place, "the frame '" + from->text + "' has no path to the ground frame '0'" + (made.contains(from->text) ? ": its transforms form a circle" : ": no transform makes it"));
      }
      add_transform(*next);
      pending.erase(next);
    }
  }

  void add_transform(const Mapping& entry) {
    Scene::Transform transform;
    transform.from = entry.at("from")->text;
    transform.to = entry.at("to")->text;
    transform.parent = frame_index_.at(transform.from);
    transform.place = entry.node().place;
    const auto part = [&](const char* key, const Dimension& wanted) {
      const NodePtr node = entry.find(key);
      return node ? formula(*node, wanted, std::string(key), moving_) : constant_formula(0, wanted, entry.node().place);
    };
    transform.theta = part("theta", kPure);
    transform.s = part("s", kLength);
    transform.a = part("a", kLength);
    transform.alpha = part("alpha", kPure);
    find_coordinate(transform);
    frame_index_[transform.to] = static_cast<int>(scene_.frames.size());
    scene_.frames.push_back(transform.to);
    scene_.transforms.push_back(std::move(transform));
  }

  /// Which coordinate varies the transform: at most one, in theta or s, affinely.
  void find_coordinate(Scene::Transform& transform) const {
    const Symbols symbols(scene_);
    for (const auto* part : {&transform.theta, &transform.s, &transform.a, &transform.alpha}) {
      if (depends_on(*part, [&](int symbol) { return symbol == Symbols::kTime || symbols.is_psi(symbol); }))
        throw InputError("varying_number", part->place, "a transform varies by coordinates only, not by motors or time directly; name a coordinate with that constraint");
      for (int j = 0; j < scene_.m(); ++j) {
        const int power = degree(*part, [&](int symbol) { return symbol == symbols.q0 + j; });
        if (power == 0) continue;
        const std::string& name = scene_.coordinates[static_cast<std::size_t>(j)].name;
        if (part == &transform.a || part == &transform.alpha)
          throw InputError("varying_number", part->place, "a and alpha are constant; '" + name + "' may vary theta or s");
        if (power > 1) throw InputError("varying_number", part->place, "not affine in '" + name + "'; put the formula into its constraint");
        if (transform.coordinate) throw InputError("varying_number", part->place, "a second varying coordinate '" + name + "' in one transform; expected at most one");
        transform.coordinate = j;
        transform.prismatic = part == &transform.s;
      }
    }
  }

  int frame(const Mapping& entry) const {
    const NodePtr node = entry.at("frame");
    const std::string& name = text_of(*node, "a frame's name");
    const auto found = frame_index_.find(name);
    if (found == frame_index_.end())
      throw InputError("broken_path", node->place, entry.what() + " sits on the frame '" + name + "', which no transform makes" + suggestion(name, scene_.frames));
    return found->second;
  }

  void read_bodies() {
    for (const auto& item : items_of(root_.at("bodies"), "the bodies")) {
      Scene::Body body;
      const Mapping entry(item, "a body", {"name", "frame", "mass", "center_of_mass", "inertia"});
      body.place = item->place;
      body.frame = frame(entry);
      const NodePtr name = entry.find("name");
      body.name = name ? text_of(*name, "a body's name") : fmt::format("body {}", scene_.bodies.size() + 1);
      body.mass = number(*entry.at("mass"), kMass, "the mass");
      body.center_of_mass = vector(entry.find("center_of_mass"), kLength, "the centre of mass", fixed_);
      body.inertia.fill(constant_formula(0, kInertia, item->place));
      if (const NodePtr tensor = entry.find("inertia")) read_inertia(tensor, body);
      scene_.bodies.push_back(std::move(body));
    }
  }

  void read_inertia(const NodePtr& node, Scene::Body& body) const {
    static const std::vector<std::string> names = {"xx", "yy", "zz", "xy", "xz", "yz"};
    const Mapping entry(node, "an inertia", names);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const NodePtr element = i < 3 ? entry.at(names[i]) : entry.find(names[i]);
      if (element) body.inertia[i] = number(*element, kInertia, "I_" + names[i]);
    }
  }

  void read_loads() {
    const NodePtr node = root_.find("loads");
    if (!node || node->kind == Node::Kind::kEmpty) return;
    Scope timed = fixed_;
    timed.define_symbol("t", Symbols::kTime, kTime, {});
    for (const auto& item : items_of(node, "the loads")) {
      const Mapping entry(item, "a load", {"frame", "point", "force", "moment"});
      scene_.loads.push_back({frame(entry), vector(entry.find("point"), kLength, "the point", fixed_),
                              vector(entry.find("force"), kForce, "the force", timed), vector(entry.find("moment"), kMoment, "the moment", timed)});
    }
  }

  void read_gravity() { scene_.gravity = vector(root_.find("gravity"), kAcceleration, "gravity", fixed_); }

  void read_end_effector() {
    const Mapping entry(root_.at("end_effector"), "the end effector", {"frame", "point", "axes"});
    scene_.end_effector.frame = frame(entry);
    scene_.end_effector.point = vector(entry.find("point"), kLength, "the end effector's point", fixed_);
    const NodePtr axes = entry.find("axes");
    if (!axes) return;
    scene_.end_effector.axes.clear();
    for (const auto& item : items_of(axes, "axes out of x, y, z")) {
      const int axis = static_cast<int>(word_of(*item, {kAxes[0], kAxes[1], kAxes[2]}, "an axis"));
      if (std::find(scene_.end_effector.axes.begin(), scene_.end_effector.axes.end(), axis) != scene_.end_effector.axes.end())
        throw InputError("doubly_defined", item->place, "an axis given twice");
      scene_.end_effector.axes.push_back(axis);
    }
  }

  void read_home() {
    scene_.home.assign(scene_.motors.size(), 0.0);
    const NodePtr node = root_.find("home");
    if (!node) return;
    std::vector<std::string> names;
    for (const auto& motor : scene_.motors) names.push_back(motor.name);
    const Mapping entry(node, "home", names);
    for (std::size_t i = 0; i < names.size(); ++i)
      if (const NodePtr value = entry.find(names[i])) {
        const Formula psi = number(*value, scene_.motors[i].linear ? kLength : kPure, "the motor's position");
        if (!psi.is_constant()) throw InputError("varying_number", value->place, "home depends on no parameter; expected a number");
        scene_.home[i] = psi.constant();
      }
  }

  void read_singularities() {
    const Node* node = section("singularities");
    if (!node) return;
    for (const auto& entry : node->entries)
      scene_.singularities.push_back({entry.key, parse_formula(*entry.value, "a formula", moving_), entry.place});
  }

  /// A body of mass has principal moments each at most the sum of the other two; Table B-2 of the paper
  /// and many data sheets round past that, so it is no error.
  void warn_of_triangles() {
    for (const auto& body : scene_.bodies) {
      if (!std::all_of(body.inertia.begin(), body.inertia.end(), [](const Formula& element) { return element.is_constant(); })) continue;
      Eigen::Matrix3d tensor;
      const auto I = [&](std::size_t i) { return body.inertia[i].constant(); };
      tensor << I(0), I(3), I(4), I(3), I(1), I(5), I(4), I(5), I(2);
      const Eigen::Vector3d principal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor, Eigen::EigenvaluesOnly).eigenvalues();
      if (principal[2] > (principal[0] + principal[1]) * (1 + 1e-12))
        scene_.warnings.push_back(to_string(body.place) + fmt::format(": {}'s largest moment of inertia {:.6g} kg m^2 exceeds the sum of the others, {:.6g}: no real mass is spread so",
                                                                      body.name, principal[2], principal[0] + principal[1]));
    }
  }

  Mapping root_;
  Scene scene_;
  Scope fixed_;   ///< parameters and constants
  Scope moving_;  ///< and time, motors and coordinates
  std::map<std::string, int> coordinate_index_;
  std::map<std::string, int> frame_index_;
};

}  // namespace

Scene load_scene(const NodePtr& document) { return SceneReader(document).read(); }

Scene load_scene(const std::filesystem::path& path) { return load_scene(read_document(path)); }

std::vector<double> parameter_values(const Scene& scene, const NodePtr& overrides, std::vector<double> values) {
  if (!overrides || overrides->kind == Node::Kind::kEmpty) return values;
  std::vector<std::string> names;
  for (const auto& parameter : scene.parameters) names.push_back(parameter.name);
  const Mapping entry(overrides, "the parameters", names);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (const NodePtr value = entry.find(names[i])) values[i] = number_of(*value, scene.parameters[i].dimension, "the parameter '" + names[i] + "'");
  try {
    check_physical(scene, values);
  } catch (const InputError& error) {
    throw InputError(error.code, overrides->place, "with these parameters, " + error.message);
  }
  return values;
}

}  // namespace mixloop
