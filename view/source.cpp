// SPDX-License-Identifier: MIT
#include "view/source.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>

#include "loop/position_error.hpp"
#include "view/write_list.hpp"

namespace mixloop {
namespace {

void write(fmt::memory_buffer& out, const char* key, std::span<const double> values) {
  fmt::format_to(std::back_inserter(out), ",\"{}\":", key);
  write_list(out, values);
}

}  // namespace

void refuse_switched(const Place& place) {
  throw InputError(
      "switched_coordinates", place,
      "its plant switches coordinates (near_singular): the motors' alone, which messages and "
      "records have, don't say how the others stand, so no pose can be drawn; expected a run with "
      "near_singular: stop");
}

std::string pose_json(Skeleton& skeleton, const Pose& pose, const std::string& traces) {
  skeleton.place(pose.psi, pose.t);
  std::vector<double> frames;
  for (std::size_t i = 0; i < skeleton.frames(); ++i) {
    const auto& frame = skeleton.frame(i);
    const Eigen::Quaterniond turn(Eigen::Matrix3d(frame.leftCols<3>()));
    frames.insert(frames.end(),
                  {frame(0, 3), frame(1, 3), frame(2, 3), turn.x(), turn.y(), turn.z(), turn.w()});
  }
  const Eigen::Vector3d E = skeleton.end_effector();
  const double error = position_error(E, pose.desired, skeleton.scene().end_effector.axes);

  fmt::memory_buffer out;
  // The session is text: it has more digits than a script's number holds.
  fmt::format_to(std::back_inserter(out), "{{\"k\":{},\"session\":\"{}\",\"flags\":{},\"note\":{}", pose.k,
                 pose.session, pose.flags, nlohmann::json(pose.note).dump());
  fmt::format_to(std::back_inserter(out), ",\"t\":{}", pose.t);
  write(out, "psi", pose.psi);
  write(out, "q", skeleton.q());
  write(out, "tau", pose.tau);
  write(out, "frames", frames);
  write(out, "E", {E.data(), 3});
  write(out, "desired", {pose.desired.data(), 3});
  write(out, "error", {&error, 1});
  fmt::format_to(std::back_inserter(out), ",\"traces\":{}}}", traces.empty() ? "null" : traces);
  return fmt::to_string(out);
}

Trace trace_of(double t, const Eigen::Vector3d& actual, const Eigen::Vector3d& desired,
               std::span<const int> axes, std::span<const double> tau) {
  const Eigen::Vector3f place = actual.cast<float>();
  return {.t = t,
          .error = static_cast<float>(position_error(actual, desired, axes)),
          .tau = {tau.begin(), tau.end()},
          .place = {place[0], place[1], place[2]}};
}

nlohmann::json path_json(const std::vector<Eigen::Vector3d>& path, std::size_t most) {
  Eigen::AlignedBox3d box;
  for (const auto& place : path)
    if (place.allFinite()) box.extend(place);
  const double cell =
      box.isEmpty() ? 1 : std::max(1e-9, 2 * box.diagonal().norm() / static_cast<double>(most));
  std::set<std::array<std::int64_t, 3>> seen;
  std::vector<Eigen::Vector3d> fresh;
  for (const auto& place : path) {
    if (!place.allFinite()) continue;
    const Eigen::Vector3d at = ((place - box.min()) / cell).array().floor();
    const std::array<std::int64_t, 3> here = {std::int64_t(at[0]), std::int64_t(at[1]), std::int64_t(at[2])};
    if (seen.insert(here).second) fresh.push_back(place);
  }
  auto list = nlohmann::json::array();
  const std::size_t points = std::min(most, fresh.size());
  for (std::size_t i = 0; i < points; ++i) {
    const auto& place = fresh[points < 2 ? 0 : i * (fresh.size() - 1) / (points - 1)];
    list.push_back({place[0], place[1], place[2]});
  }
  return list;
}

}  // namespace mixloop
