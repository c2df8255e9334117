// SPDX-License-Identifier: MIT
#include "view/skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dynamics/procedure/constraints.hpp"
#include "dynamics/procedure/kinematics.hpp"

namespace mixloop {
namespace {

constexpr double kSame = 1e-9;  // m: far above round-off of metres, far below what anyone draws

Eigen::Vector3d seen_from(const Mat34<double>& frame, const Eigen::Vector3d& place) {
  return frame.leftCols<3>().transpose() * (place - frame.col(3));
}

}  // namespace

Skeleton::Skeleton(std::shared_ptr<const Scene> scene, std::span<const double> parameters)
    : scene_(std::move(scene)), model_(make_model<double>(scene_, parameters)), ws_(model_) {
  const std::vector<Posture> poses = some_poses();
  closures_ = find_closures(poses);
  joints_ = joints_of_motors(poses);
  for (const auto& frame : poses[0].frames) at_home_.push_back(frame.col(3));
  place(scene_->home, 0);
  extent_ = reached();
}

// By centres of mass, solids and the end effector: a mechanism's frames may all lie in one point.
std::vector<Eigen::Vector3d> Skeleton::reached() const {
  std::vector<Eigen::Vector3d> places;
  const auto add = [&](int frame, const Eigen::Vector3d& point) {
    places.push_back(at_point<double>(ws_.frames[static_cast<std::size_t>(frame)].T_0, point));
  };
  for (const auto& body : model_.bodies) add(body.frame, body.center_of_mass);
  for (const Scene::Solid& solid : scene_->solids) {
    const Eigen::Vector3d around =
        solid.shape == Scene::Solid::Shape::box
            ? Eigen::Vector3d(Eigen::Map<const Eigen::Vector3d>(solid.size.data()) / 2)
            : Eigen::Vector3d(Eigen::Vector3d::Constant(solid.radius));
    add(solid.frame, Eigen::Map<const Eigen::Vector3d>(solid.from.data()) - around);
    add(solid.frame, Eigen::Map<const Eigen::Vector3d>(solid.to.data()) + around);
  }
  if (scene_->end_effector.named) places.push_back(end_effector());
  return places;
}

void Skeleton::place(std::span<const double> psi, double t) {
  coordinates<double>(model_, psi, t, ws_);
  frame_variations(model_, ws_);
}

Eigen::Vector3d Skeleton::end_effector() const {
  if (!scene_->end_effector.named) return Eigen::Vector3d::Constant(std::nan(""));
  return at_point<double>(ws_.frames[static_cast<std::size_t>(scene_->end_effector.frame)].T_0,
                          model_.end_effector_point);
}

// At home, and around it.
std::vector<Skeleton::Posture> Skeleton::some_poses() {
  constexpr int kPoses = 4;
  std::vector<Posture> poses;
  for (int pose = 0; pose < kPoses; ++pose) {
    // As far as its closures let it.
    double reach = 0.3 * pose;
    for (int tries = 0; tries < 8; ++tries, reach /= 2) {
      std::vector<double> psi = scene_->home;
      for (std::size_t i = 0; i < psi.size(); ++i)
        psi[i] += reach * std::cos(1.0 + 2.0 * static_cast<double>(i));
      place(psi, 0);
      if (ws_.is_solved) break;
    }
    poses.push_back({.frames = {}, .C = ws_.C});
    for (const auto& frame : ws_.frames) poses.back().frames.push_back(frame.T_0);
  }
  return poses;
}

// The description says which frames make the tree, not where its loops close: a leaf whose origin stays where
// it is in another body's frame, at all of some poses, is joined to that body there. Bodies that only ever
// move in parallel stand still in each other's frames too: of several the nearest is it.
std::vector<Skeleton::Closure> Skeleton::find_closures(const std::vector<Posture>& poses) const {
  const std::size_t count = ws_.frames.size();
  std::vector<bool> is_leaf(count, true);
  for (const auto& link : model_.links) is_leaf[static_cast<std::size_t>(link.parent)] = false;
  is_leaf[static_cast<std::size_t>(scene_->end_effector.frame)] = false;

  const auto seen = [](const Posture& pose, std::size_t leaf, std::size_t on) {
    return seen_from(pose.frames[on], pose.frames[leaf].col(3));
  };
  const auto stands_still = [&](std::size_t leaf, std::size_t on) {
    return std::all_of(poses.begin(), poses.end(), [&](const Posture& pose) {
      return (seen(pose, leaf, on) - seen(poses[0], leaf, on)).norm() < kSame;
    });
  };
  std::vector<Closure> closures;
  for (std::size_t leaf = 1; leaf < count; ++leaf) {
    std::size_t parent = leaf;  // past the frames amid a pose, which have no name
    do parent = static_cast<std::size_t>(model_.links[parent - 1].parent);
    while (scene_->frames[parent].empty());
    std::size_t nearest = leaf;
    for (std::size_t on = 0; is_leaf[leaf] && on < count; ++on) {
      if (on == leaf || on == parent || scene_->frames[on].empty() || !stands_still(leaf, on)) continue;
      if (nearest == leaf || seen(poses[0], leaf, on).norm() < seen(poses[0], leaf, nearest).norm() - kSame)
        nearest = on;
    }
    const bool is_known = std::any_of(closures.begin(), closures.end(), [&](const Closure& one) {
      return one.leaf == nearest && one.on == leaf;  // two leaves that meet are one closure
    });
    if (nearest != leaf && !is_known) closures.push_back({leaf, nearest});
  }
  return closures;
}

// A motor's torque is shown at a joint that it moves and no motor before it has taken: one that turns
// (slides) as the motor does, by a constant ratio, where there is such a one; of several the nearest to the
// ground.
std::vector<int> Skeleton::joints_of_motors(const std::vector<Posture>& poses) const {
  std::vector<int> depth(ws_.frames.size(), 0);
  for (std::size_t i = 0; i < model_.links.size(); ++i)
    depth[i + 1] = depth[static_cast<std::size_t>(model_.links[i].parent)] + 1;
  std::vector<int> joints;
  for (int motor = 0; motor < scene_->n_u(); ++motor) {
    const auto ratio = [&](const Posture& pose, int coordinate) { return pose.C(coordinate, motor); };
    const auto is_geared = [&](int coordinate) {
      return std::all_of(poses.begin(), poses.end(), [&](const Posture& pose) {
        return std::abs(ratio(pose, coordinate) - ratio(poses[0], coordinate)) < kSame;
      });
    };
    std::pair<bool, int> best;  // not the motor's own kind of joint, depth
    int joint = -1;
    for (std::size_t i = 0; i < model_.links.size(); ++i) {
      const auto& link = model_.links[i];
      const int frame = static_cast<int>(i + 1);
      if (link.coordinate < 0 || std::abs(ratio(poses[0], link.coordinate)) < kSame) continue;
      if (std::find(joints.begin(), joints.end(), frame) != joints.end()) continue;
      const bool is_like = link.prismatic == scene_->motors()[static_cast<std::size_t>(motor)].linear;
      const std::pair here{!is_like || !is_geared(link.coordinate), depth[i + 1]};
      if (joint < 0 || here < best) best = here, joint = frame;
    }
    joints.push_back(joint);
  }
  return joints;
}

nlohmann::json Skeleton::description() const {
  using nlohmann::json;
  const auto list = [](const Eigen::Vector3d& v) { return json{v[0], v[1], v[2]}; };
  json frames = json::array(), bodies = json::array(), motors = json::array(), closures = json::array(),
       solids = json::array();
  frames.push_back({{"name", scene_->frames[0]}, {"parent", -1}, {"home", list(at_home_[0])}});
  for (std::size_t i = 0; i < model_.links.size(); ++i) {
    const auto& link = model_.links[i];
    frames.push_back({{"name", scene_->frames[i + 1]},
                      {"parent", link.parent},
                      {"prismatic", link.prismatic},
                      {"home", list(at_home_[i + 1])}});
    if (link.coordinate >= 0)
      frames.back()["coordinate"] = scene_->coordinates[static_cast<std::size_t>(link.coordinate)].name;
  }
  for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
    const auto& body = model_.bodies[i];
    bodies.push_back({{"name", scene_->bodies[i].name},
                      {"frame", body.frame},
                      {"mass", body.mass},
                      {"center_of_mass", list(body.center_of_mass)}});
  }
  for (const Scene::Solid& solid : scene_->solids)
    solids.push_back({{"frame", solid.frame},
                      {"shape", Scene::Solid::kShapes[static_cast<std::size_t>(solid.shape)]},
                      {"size", solid.size},
                      {"radius", solid.radius},
                      {"from", solid.from},
                      {"to", solid.to}});
  for (std::size_t i = 0; i < joints_.size(); ++i)
    motors.push_back(
        {{"name", scene_->motors()[i].name}, {"linear", scene_->motors()[i].linear}, {"joint", joints_[i]}});
  json extent = json::array();
  for (const auto& place : extent_) extent.push_back(list(place));
  for (const auto& closure : closures_) closures.push_back({{"leaf", closure.leaf}, {"on", closure.on}});
  return {
      {"name", scene_->name},
      {"frames", frames},
      {"bodies", bodies},
      {"motors", motors},
      {"closures", closures},
      {"solids", solids},
      {"extent", extent},
      {"gravity", list(model_.gravity)},
      {"end_effector", {{"frame", scene_->end_effector.frame}, {"point", list(model_.end_effector_point)}}}};
}

}  // namespace mixloop
