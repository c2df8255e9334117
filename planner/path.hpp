// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dynamics/scene/scene.hpp"
#include "notation/document.hpp"

namespace mixloop {

/// A path of the end effector: straight lines from point to point, each at rest at both ends and run through
/// by the cycloidal motion program (34).
struct Path {
  struct Via {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m; only the scene's axes count
    double duration = 0;  ///< of the line that leads here, s; 0 for the first point
    double dwell = 0;     ///< rest here before going on, s
    Place place = {};
  };
  std::vector<Via> vias;              ///< two or more
  std::vector<int> axes = {0, 1, 2};  ///< which of x, y, z the points prescribe
  int repeat = 0;                     ///< there and back so many times; 0: there once
  std::optional<double> approach;     ///< duration of a move to the start, s; empty: chosen by the plan
  Place place;
};

/// Reads an experiment's `path:`, either
///   {line: {from: [...], to: [...]}, duration: 1 s}   or
///   {via: [{at: [...]}, {at: [...], duration: 0.6 s, dwell: 0.1 s}, ...]}
/// with optional `profile: cycloidal`, `repeat: N` and `approach: 2 s`. Beside `via`, `duration` is that of
/// lines which have none of their own. Points have one value for each of the scene's end effector axes, in
/// their order. Throws InputError.
Path read_path(const NodePtr& node, const Scene& scene);

}  // namespace mixloop
