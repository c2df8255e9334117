// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "dynamics/procedure/workspace.hpp"

namespace mixloop {

/// Where a scene's frames are: what a viewer draws. An object belongs to one thread.
class Skeleton {
 public:
  Skeleton(std::shared_ptr<const Scene> scene, std::span<const double> parameters);

  const Scene& scene() const { return *scene_; }
  int n() const { return scene_->n(); }

  /// Moves every frame to psi.
  void place(std::span<const double> psi, double t);

  std::size_t frames() const { return ws_.frames.size(); }  ///< the ground included
  /// After place(): a frame's transform to frame 0, m.
  const Mat34<double>& frame(std::size_t i) const { return ws_.frames[i].T_0; }
  Eigen::Vector3d end_effector() const;
  std::span<const double> q() const { return {ws_.q.data(), static_cast<std::size_t>(ws_.q.size())}; }

  /// What never moves, as the page reads it: frames (name, empty of those amid a pose, parent, joint's
  /// coordinate, prismatic, its origin at home), bodies (name, frame, mass, center_of_mass), motors (name,
  /// linear, joint: the frame at whose joint its torque is shown), closures (see closures()), solids (frame,
  /// shape, size, radius, from, to: see Scene::Solid), extent (places at home, ground axes: how far what is
  /// drawn beside frames reaches), end_effector {frame, point}.
  nlohmann::json description() const;

  /// Where a branch of the tree ends on another body: frame `leaf`'s origin stands still in frame `on`.
  struct Closure {
    std::size_t leaf, on;
  };
  const std::vector<Closure>& closures() const { return closures_; }

 private:
  struct Posture {
    std::vector<Mat34<double>> frames;  ///< to frame 0, m
    Mat<double> C;                      ///< m x n
  };
  std::vector<Eigen::Vector3d> reached() const;
  std::vector<Posture> some_poses();
  std::vector<Closure> find_closures(const std::vector<Posture>& poses) const;
  std::vector<int> joints_of_motors(const std::vector<Posture>& poses) const;

  std::shared_ptr<const Scene> scene_;
  Model<double> model_;
  Workspace<double> ws_;
  std::vector<Closure> closures_;
  std::vector<int> joints_;               ///< of each motor: a frame, or -1
  std::vector<Eigen::Vector3d> at_home_;  ///< frames' origins, m
  std::vector<Eigen::Vector3d> extent_;   ///< what else is drawn at home reaches so far, m
};

}  // namespace mixloop
