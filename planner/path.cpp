// SPDX-License-Identifier: MIT
#include "planner/path.hpp"

#include <fmt/format.h>

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
  static const Keys keys{
      "a via point",
      {{"at", form::numbers(), kRequired}, {"duration", form::number()}, {"dwell", form::number()}}};
  return keys;
}

Eigen::Vector3d read_point(const NodePtr& node, const Scene& scene, const std::string& what) {
  const auto& axes = scene.end_effector.axes;
  const std::vector<double> values = numbers_of(node, kLength, axes.size(), what);
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < axes.size(); ++i) point[axes[i]] = values[i];
  return point;
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
  const NodePtr from = line.at("from"), to = line.at("to");
  path.vias.push_back({.point = read_point(from, scene, "the line's first point"), .place = from->place});
  path.vias.push_back({.point = read_point(to, scene, "the line's last point"),
                       .duration = read_duration(*duration, "the path's duration", false),
                       .place = to->place});
}

Path::Via read_via(const NodePtr& item, const NodePtr& usual_duration, bool is_first, const Scene& scene) {
  const Mapping entry = read_mapping(item, via_keys());
  Path::Via via{.point = read_point(entry.at("at"), scene, "a via point"), .place = item->place};
  if (const NodePtr dwell = entry.find("dwell")) via.dwell = read_duration(*dwell, "the dwell", true);
  const NodePtr own = entry.find("duration");
  if (is_first) {
    if (own)
      throw InputError(
          "unknown_key", own->place,
          "no line leads to the first point; expected its duration beside the point that it leads to");
    return via;
  }
  const NodePtr duration = own ? own : usual_duration;
  if (!duration)
    throw InputError("missing_key", item->place,
                     "a via point without 'duration'; expected that of the line that leads to it");
  via.duration = read_duration(*duration, "the duration", false);
  return via;
}

}  // namespace

const Keys& path_keys() {
  static const Keys keys{"the path",
                         {{"line", form::mapping(line_keys)},
                          {"via", form::list(form::mapping(via_keys))},
                          {"profile", form::word({"cycloidal"})},
                          {"duration", form::number()},
                          {"repeat", form::whole()},
                          {"approach", form::number()}}};
  return keys;
}

Path read_path(const NodePtr& node, const Scene& scene) {
  const Mapping entry = read_mapping(node, path_keys());
  if (!scene.end_effector.named)
    throw InputError(
        "missing_key", node->place,
        "the scene names no end_effector, so nothing follows a path; expected one, or `duration` "
        "in place of the path");
  Path path;
  path.axes = scene.end_effector.axes;
  path.place = node->place;
  if (entry.has("line") == entry.has("via"))
    throw InputError("missing_key", node->place,
                     entry.has("line") ? "the path has both 'line' and 'via'; expected one of them"
                                       : "the path has neither 'line' nor 'via'; expected one of them");
  if (const NodePtr line = entry.find("line")) {
    read_line(line, entry.at("duration"), scene, path);
  } else {
    const auto items = items_of(entry.at("via"), "the via points");
    if (items.size() < 2)
      throw InputError("wrong_size", entry.at("via")->place,
                       "a path through one point; expected two or more");
    for (const auto& item : items)
      path.vias.push_back(read_via(item, entry.find("duration"), path.vias.empty(), scene));
  }
  if (const NodePtr profile = entry.find("profile"))
    word_of(*profile, words_of(path_keys(), "profile"), "the profile");
  if (const NodePtr repeat = entry.find("repeat"))
    path.repeat = static_cast<int>(whole_number_of(*repeat, 0, kMostLaps, "repeat"));
  if (const NodePtr approach = entry.find("approach"))
    path.approach = read_duration(*approach, "the approach", false);
  return path;
}

}  // namespace mixloop
