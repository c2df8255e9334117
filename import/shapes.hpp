// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "import/robot.hpp"

namespace mixloop {

/// Whether a shape can be a scene's solid: a box, a cylinder or a sphere that has an extent.
inline bool is_solid(const Robot::Shape& shape) {
  using Kind = Robot::Shape::Kind;
  if (shape.kind == Kind::box) return shape.size[0] > 0 && shape.size[1] > 0 && shape.size[2] > 0;
  return shape.kind != Kind::mesh && shape.radius > 0 && (shape.kind == Kind::sphere || shape.length > 0);
}

/// What is drawn of a link: its visual shapes that can be solids; where there is none, its collision shapes.
inline std::vector<Robot::Shape> solids_of(const Robot::Link& link) {
  std::vector<Robot::Shape> solids;
  for (const auto* shapes : {&link.visuals, &link.collisions}) {
    for (const auto& shape : *shapes)
      if (is_solid(shape)) solids.push_back(shape);
    if (!solids.empty()) break;
  }
  return solids;
}

}  // namespace mixloop
