// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "notation/errors.hpp"

namespace mixloop {

using Triple = std::array<double, 3>;

/// Moved by `at`, then turned by Rz(yaw) Ry(pitch) Rx(roll): m and rad.
struct FixedPose {
  Triple at = {}, rpy = {};  ///< roll, pitch, yaw

  bool is_turned() const { return rpy != Triple{}; }
};

/// A tree of links and joints, as its file describes it, checked, in SI and radians.
struct Robot {
  struct Inertial {
    FixedPose origin;                 ///< centre of mass and the inertia's axes, in the link's frame
    double mass = 0;                  ///< kg
    std::array<double, 6> inertia{};  ///< kg m^2: xx, yy, zz, xy, xz, yz in the origin's axes
    Place place;
  };

  /// What a viewer draws.
  struct Shape {
    enum class Kind { box, cylinder, sphere, mesh };

    Kind kind = Kind::box;
    FixedPose origin;
    Triple size = {};               ///< a box's edges, m
    double radius = 0, length = 0;  ///< of the others, m
  };

  /// Links stand parents first; a joint leads to each but the first, whose frame is the ground.
  struct Link {
    std::string name;
    std::optional<Inertial> inertial;
    std::vector<Shape> visuals, collisions;
    int joint = -1;  ///< that leads to it
    Place place;
  };

  struct Limits {
    double lower = 0, upper = 0;      ///< rad or m
    double velocity = 0, effort = 0;  ///< rad/s or m/s; N m or N
  };

  /// position = multiplier * position of another joint + offset.
  struct Mimic {
    int joint = -1;
    double multiplier = 1, offset = 0;
    Place place;
  };

  struct Joint {
    enum class Kind { fixed, revolute, continuous, prismatic, floating, planar };

    std::string name;
    Kind kind = Kind::fixed;
    int parent = 0, child = 0;  ///< links
    FixedPose origin;           ///< of the child's frame in the parent's
    Triple axis = {1, 0, 0};    ///< in the child's frame, of any length but 0
    std::optional<Limits> limits;
    double damping = 0, friction = 0;  ///< N m s/rad or N s/m; N m or N
    std::optional<Mimic> mimic;
    Place place;

    bool moves() const {
      return kind == Kind::revolute || kind == Kind::continuous || kind == Kind::prismatic;
    }
    bool slides() const { return kind == Kind::prismatic; }
  };

  std::string name;
  std::vector<Link> links;
  std::vector<Joint> joints;  ///< in the order of the links that they lead to
};

}  // namespace mixloop
