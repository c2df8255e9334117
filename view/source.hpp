// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "view/skeleton.hpp"
#include "view/traces.hpp"

namespace mixloop {

/// One tick as the page draws it.
struct Pose {
  std::int64_t k = -1;
  double t = 0;
  std::int64_t session = 0;
  std::vector<double> psi;  ///< n
  std::vector<double> tau;  ///< n_u, NaN where no command is known
  Eigen::Vector3d desired = Eigen::Vector3d::Constant(std::nan(""));
  std::int32_t flags = 0;  ///< of state_t
  std::string note;        ///< what a person must know of it; empty where that is nothing
};

/// A run that switches coordinates can't be drawn.
[[noreturn]] void refuse_switched(const Place& place);

/// A pose as JSON {"k", "t", "session", "flags", "note", "psi", "q", "tau", "frames": [x, y, z, qx, qy, qz,
/// qw, ...], "E", "desired", "error"}, with `traces` (JSON) beside it.
std::string pose_json(Skeleton& skeleton, const Pose& pose, const std::string& traces);

/// What the plots draw of a tick: the end effector and where it should be (m, NaN where that isn't known),
/// over the axes that the path prescribes, and the commanded torques.
Trace trace_of(double t, const Eigen::Vector3d& actual, const Eigen::Vector3d& desired,
               std::span<const int> axes, std::span<const double> tau);

/// Where a browser has come to.
struct Cursor {
  std::int64_t version = -1;  ///< of the pose it was sent last
  std::int64_t traces = -1;   ///< see Traces::count; -1: none was sent
};

/// What is shown: a bus, or a log.
class Source {
 public:
  virtual ~Source() = default;
  /// All that does not move, as JSON: {"mode": "live" | "log", "mechanism", "path", ...}.
  virtual std::string description() = 0;
  /// Changes with every new pose.
  virtual std::int64_t version() = 0;
  /// The newest pose, and what the plots have missed since the cursor, which goes along.
  virtual std::string newest(Cursor& cursor) = 0;
  /// The pose at a tick that the page asks for; empty where there is nothing to seek in.
  virtual std::string at_tick(std::int64_t) { return {}; }
};

/// Points of a path for the page, at most `most`: a place that it comes back to (another lap) is left out,
/// and so is one that is not finite.
nlohmann::json path_json(const std::vector<Eigen::Vector3d>& path, std::size_t most = 600);

}  // namespace mixloop
