// SPDX-License-Identifier: MIT
#pragma once

#include "planner/hand_kinematics.hpp"
#include "planner/path.hpp"

namespace mixloop {

/// The direction of an end effector that has one, in its frame: length 1.
Eigen::Vector3d axis_of(const Scene::EndEffector& end_effector);

/// Rz(yaw) Ry(pitch) Rx(roll), as `rpy` of a scene's poses.
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& roll_pitch_yaw);

/// The shortest turn that takes the direction `from` to `to` (length 1 each); about any axis where they are
/// opposite.
Eigen::Matrix3d shortest_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// The turn by an angle about an axis, given as the angle times the axis, rad.
Eigen::Matrix3d turn_by(const Eigen::Vector3d& rotation_vector);

/// The other way round: the angle of a turn times its axis, rad; its length at most pi.
Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& turn);

/// The path with the frame's rotation at each of its points: as its turns say, or from home on, the shortest
/// way from direction to direction. Throws InputError where the way from one to the next is half a turn,
/// which may be gone either way round.
Path oriented(Path path, HandKinematics& hand);

}  // namespace mixloop
