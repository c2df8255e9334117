// SPDX-License-Identifier: MIT
#include "planner/path.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "dynamics/scene/coordinate_values.hpp"
#include "notation/nearest.hpp"
#include "notation/utf8.hpp"
#include "notation/value.hpp"
#include "planner/path_keys.hpp"

namespace mixloop {
namespace {

constexpr long kMostLaps = 1'000'000;

const Keys& line_keys() {
  static const Keys keys{"the line",
                         {{"from", form::numbers(), kRequired}, {"to", form::numbers(), kRequired}}};
  return keys;
}

const Keys& via_keys() {
  static const Keys keys{"a via point",
                         {{"at", form::numbers(), kRequired},
                          {"duration", form::number()},
                          {"dwell", form::number()},
                          {"direction", form::numbers()}}};
  return keys;
}

const Keys& motor_via_keys() {
  static const Keys keys{
      "a point of the motors",
      {{"at", form::numbers(), kRequired}, {"duration", form::number()}, {"dwell", form::number()}}};
  return keys;
}

/// Of the scene's axes first where the end effector is, then how it is turned.
Path::Via read_point(const NodePtr& node, const Scene& scene, const std::string& what) {
  const auto& [axes, turns] = std::tie(scene.end_effector.axes, scene.end_effector.turns);
  Path::Via via{.place = node->place};
  if (turns.empty()) {
    const std::vector<double> values = numbers_of(node, kLength, axes.size(), what);
    for (std::size_t i = 0; i < axes.size(); ++i) via.point[axes[i]] = values[i];
    return via;
  }
  const auto items = items_of(node, what);
  if (items.size() != axes.size() + turns.size())
    throw InputError(
        "wrong_size", node->place,
        fmt::format("found {}; expected {}, a list of {}: {} of place, then {} of turning", describe(*node),
                    what, axes.size() + turns.size(), axes.size(), turns.size()));
  for (std::size_t i = 0; i < axes.size(); ++i) via.point[axes[i]] = number_of(*items[i], kLength, what);
  for (std::size_t i = 0; i < turns.size(); ++i)
    via.turns[static_cast<Eigen::Index>(i)] = number_of(*items[axes.size() + i], kPure, what);
  return via;
}

Eigen::Vector3d read_direction(const NodePtr& node, const Scene& scene) {
  if (!scene.end_effector.direction)
    throw InputError(
        "unknown_key", node->place,
        "the scene's end effector has no 'direction' of its own, so nothing points anywhere; expected "
        "one there, or none here");
  const std::vector<double> values = numbers_of(node, kPure, 3, "the direction");
  const Eigen::Vector3d direction(values[0], values[1], values[2]);
  if (!(direction.norm() > 0))
    throw InputError("out_of_range", node->place, "the direction is [0, 0, 0]; expected where to point");
  return direction.normalized();
}

double read_duration(const Node& node, const std::string& what, bool may_be_zero) {
  const double seconds = number_of(node, kTime, what);
  if (seconds < 0 || (seconds == 0 && !may_be_zero))
    throw InputError(
        "out_of_range", node.place,
        fmt::format("{} is {} s; expected {}", what, seconds, may_be_zero ? "0 or more" : "more than 0"));
  return seconds;
}

void read_line(const NodePtr& node, const NodePtr& duration, const Scene& scene, Path& path) {
  const Mapping line = read_mapping(node, line_keys());
  path.vias.push_back(read_point(line.at("from"), scene, "the line's first point"));
  path.vias.push_back(read_point(line.at("to"), scene, "the line's last point"));
  path.vias.back().duration = read_duration(*duration, "the path's duration", false);
}

/// When a point is reached, and how long it is rested there.
void read_times(const Mapping& entry, const NodePtr& usual_duration, bool is_first, Path::Via& via) {
  via.place = entry.node().place;
  if (const NodePtr dwell = entry.find("dwell")) via.dwell = read_duration(*dwell, "the dwell", true);
  const NodePtr own = entry.find("duration");
  if (is_first) {
    if (own)
      throw InputError(
          "unknown_key", own->place,
          "no line leads to the first point; expected its duration beside the point that it leads to");
    return;
  }
  const NodePtr duration = own ? own : usual_duration;
  if (!duration)
    throw InputError("missing_key", entry.node().place,
                     "a via point without 'duration'; expected that of the line that leads to it");
  via.duration = read_duration(*duration, "the duration", false);
}

Path::Via read_via(const NodePtr& item, const NodePtr& usual_duration, bool is_first, const Scene& scene) {
  const Mapping entry = read_mapping(item, via_keys());
  Path::Via via = read_point(entry.at("at"), scene, "a via point");
  read_times(entry, usual_duration, is_first, via);
  if (const NodePtr direction = entry.find("direction")) via.direction = read_direction(direction, scene);
  return via;
}

Path::Via read_motors(const NodePtr& item, const NodePtr& usual_duration, bool is_first, const Scene& scene) {
  const Mapping entry = read_mapping(item, motor_via_keys());
  Path::Via via;
  via.motors =
      map_of(std::span<const double>(read_values(entry.at("at"), scene.motors(), kPosition, "the point")));
  read_times(entry, usual_duration, is_first, via);
  return via;
}

template <class Read>
void read_points(const Mapping& entry, const char* key, const Scene& scene, Read read, Path& path) {
  const auto items = items_of(entry.at(key), "the points");
  if (items.size() < 2)
    throw InputError("wrong_size", entry.at(key)->place, "a path through one point; expected two or more");
  for (const auto& item : items)
    path.vias.push_back(read(item, entry.find("duration"), path.vias.empty(), scene));
}

void read_held(const NodePtr& node, const Scene& scene, Path& path) {
  std::vector<std::string> names;
  for (const auto& motor : scene.motors()) names.push_back(motor.name);
  for (const auto& item : items_of(node, "the motors that are held")) {
    const int motor = static_cast<int>(word_of(*item, names, "a motor"));
    if (std::ranges::count(path.held, motor) > 0)
      throw InputError("doubly_defined", item->place,
                       "the motor " + in_quotes(item->text) + " is held twice");
    path.held.push_back(motor);
  }
}

/// What goes with a path of the end effector alone.
void read_way(const Mapping& entry, const Scene& scene, Path& path) {
  if (path.is_of_motors()) {
    for (const char* key : {"direction", "hold", "redundancy"})
      if (const NodePtr found = entry.find(key))
        throw InputError(
            "unknown_key", found->place,
            fmt::format("'{}' is of a path of the end effector, and this one is of the motors", key));
    return;
  }
  if (const NodePtr direction = entry.find("direction")) {
    const Eigen::Vector3d all = read_direction(direction, scene);
    if (!path.vias.front().direction) path.vias.front().direction = all;
  }
  if (const NodePtr hold = entry.find("hold")) read_held(hold, scene, path);
  if (const NodePtr redundancy = entry.find("redundancy")) {
    word_of(*redundancy, words_of(path_keys(), "redundancy"), "what settles the redundancy");
    path.least_norm = true;
  }
}

const char* only_kind_of(const Mapping& entry) {
  const char* kind = nullptr;
  for (const char* key : {"line", "via", "motors"}) {
    if (!entry.has(key)) continue;
    if (kind)
      throw InputError("missing_key", entry.node().place,
                       fmt::format("the path has both '{}' and '{}'; expected one of them", kind, key));
    kind = key;
  }
  if (!kind)
    throw InputError("missing_key", entry.node().place,
                     "the path has neither 'line' nor 'via' nor 'motors'; expected one of them");
  return kind;
}

}  // namespace

const Keys& path_keys() {
  static const Keys keys{"the path",
                         {{"line", form::mapping(line_keys)},
                          {"via", form::list(form::mapping(via_keys))},
                          {"motors", form::list(form::mapping(motor_via_keys))},
                          {"direction", form::numbers()},
                          {"hold", form::list(form::text())},
                          {"redundancy", form::word({"least_norm"})},
                          {"profile", form::word({"cycloidal"})},
                          {"duration", form::number()},
                          {"repeat", form::whole()},
                          {"approach", form::number()}}};
  return keys;
}

Path read_path(const NodePtr& node, const Scene& scene) {
  const Mapping entry = read_mapping(node, path_keys());
  const std::string_view kind = only_kind_of(entry);
  if (!scene.end_effector.named && kind != "motors")
    throw InputError("missing_key", node->place,
                     "the scene names no end_effector, so nothing follows a path; expected one, a path of "
                     "the `motors`, or "
                     "`duration` in place of the path");
  Path path;
  path.axes = scene.end_effector.axes;
  path.place = node->place;
  if (kind == "line")
    read_line(entry.at("line"), entry.at("duration"), scene, path);
  else if (kind == "via")
    read_points(entry, "via", scene, read_via, path);
  else
    read_points(entry, "motors", scene, read_motors, path);
  read_way(entry, scene, path);
  if (const NodePtr profile = entry.find("profile"))
    word_of(*profile, words_of(path_keys(), "profile"), "the profile");
  if (const NodePtr repeat = entry.find("repeat"))
    path.repeat = static_cast<int>(whole_number_of(*repeat, 0, kMostLaps, "repeat"));
  if (const NodePtr approach = entry.find("approach"))
    path.approach = read_duration(*approach, "the approach", false);
  return path;
}

}  // namespace mixloop
