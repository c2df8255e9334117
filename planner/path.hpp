// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dynamics/procedure/matrix.hpp"
#include "dynamics/scene/scene.hpp"
#include "notation/document.hpp"

namespace mixloop {

/// A path of the end effector, or of the motors: straight lines from point to point, each at rest at both
/// ends and run through by the cycloidal motion program (34).
struct Path {
  struct Via {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m; only the scene's axes count
    double duration = 0;  ///< of the line that leads here, s; 0 for the first point
    double dwell = 0;     ///< rest here before going on, s
    Place place = {};
    /// Where the end effector's turns are prescribed: roll, pitch and yaw, rad; or the turn about a single
    /// axis, from home, first.
    Eigen::Vector3d turns = Eigen::Vector3d::Zero();
    std::optional<Eigen::Vector3d> direction = {};  ///< where it points; none: as at the point before
    Vector motors = {};                             ///< n_u, rad or m: of a path of the motors
    Eigen::Matrix3d rotation =
        Eigen::Matrix3d::Identity();  ///< of the frame, where `oriented` has settled it
  };
  std::vector<Via> vias;              ///< two or more
  std::vector<int> axes = {0, 1, 2};  ///< which of x, y, z the points prescribe
  int repeat = 0;                     ///< there and back so many times; 0: there once
  std::optional<double> approach;     ///< duration of a move to the start, s; empty: chosen by the plan
  Place place;
  std::vector<int> held = {};  ///< motors that stay at home, of those that are more than is prescribed
  bool least_norm = false;     ///< of the others' velocities, where they still are more, the least

  bool is_of_motors() const { return !vias.empty() && vias.front().motors.size() > 0; }
};

/// Reads an experiment's `path:`, one of
///   {line: {from: [...], to: [...]}, duration: 1 s}
///   {via: [{at: [...]}, {at: [...], duration: 0.6 s, dwell: 0.1 s}, ...]}
///   {motors: [{at: [...]}, {at: [...], duration: 0.6 s, dwell: 0.1 s}, ...]}
/// with optional `profile: cycloidal`, `repeat: N` and `approach: 2 s`. Beside `via` and `motors`, `duration`
/// is that of lines which have none of their own. Points have one value for each of the scene's end effector
/// axes, in their order, those of `motors` one for each motor. Beside `line` and `via`: `direction: [x, y,
/// z]` of an end effector that has one (also of a via point), `hold: [motors]`, `redundancy: least_norm`.
/// Throws InputError.
Path read_path(const NodePtr& node, const Scene& scene);

}  // namespace mixloop
