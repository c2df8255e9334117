// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "notation/document.hpp"

namespace mixloop {

/// A path of the end effector: straight lines from point to point, each at rest at both ends.
struct Path {
  struct Via {
    Eigen::Vector3d point;   ///< m; only the scene's axes count
    double duration = 0;     ///< of the line that leads here, s; 0 for the first point
    double dwell = 0;        ///< rest here before going on, s
    Place place;
  };
  std::vector<Via> vias;     ///< two or more
  int repeat = 0;            ///< there and back so many times; 0: there once
};

}  // namespace mixloop
