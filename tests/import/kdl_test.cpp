// SPDX-License-Identifier: MIT
// What is imported moves as Orocos' Kinematics and Dynamics Library has it: a tree that the test makes of
// urdfdom's model itself, with quaternions, Newton-Euler in spatial vectors and no line of ours.
#include <gtest/gtest.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <kdl/tree.hpp>
#include <kdl/treefksolverpos_recursive.hpp>
#include <kdl/treeidsolver_recursive_newton_euler.hpp>
#include <random>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/procedure/procedure.hpp"
#include "tests/import/robots.hpp"

namespace mixloop {
namespace {

KDL::Vector vector_in(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

KDL::Frame frame_in(const urdf::Pose& pose) {
  const auto& r = pose.rotation;
  return {KDL::Rotation::Quaternion(r.x, r.y, r.z, r.w), vector_in(pose.position)};
}

KDL::Joint joint_in(const urdf::Joint& joint) {
  const KDL::Frame frame = frame_in(joint.parent_to_joint_origin_transform);
  const KDL::Vector axis = frame.M * vector_in(joint.axis);
  if (joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS)
    return {joint.name, frame.p, axis, KDL::Joint::RotAxis};
  if (joint.type == urdf::Joint::PRISMATIC) return {joint.name, frame.p, axis, KDL::Joint::TransAxis};
  return KDL::Joint(joint.name, KDL::Joint::Fixed);
}

KDL::RigidBodyInertia inertia_in(const urdf::Link& link) {
  if (!link.inertial) return KDL::RigidBodyInertia::Zero();
  const auto& said = *link.inertial;
  const KDL::Frame origin = frame_in(said.origin);
  const KDL::RigidBodyInertia about_mass(
      said.mass, KDL::Vector::Zero(),
      KDL::RotationalInertia(said.ixx, said.iyy, said.izz, said.ixy, said.ixz, said.iyz));
  return origin * about_mass;
}

void add_links(const urdf::Link& parent, KDL::Tree& tree) {
  for (const auto& child : parent.child_links) {
    const auto& joint = *child->parent_joint;
    tree.addSegment(KDL::Segment(child->name, joint_in(joint),
                                 frame_in(joint.parent_to_joint_origin_transform), inertia_in(*child)),
                    parent.name);
    add_links(*child, tree);
  }
}

/// A robot by KDL, its joints that mimic others following: q = A psi + b.
class ByKdl {
 public:
  ByKdl(const std::string& file, const Imported& made)
      : model_(urdf::parseURDFFile(file)), tree_(model_->getRoot()->name), tip_(made.tip) {
    add_links(*model_->getRoot(), tree_);
    const auto joints = static_cast<Eigen::Index>(tree_.getNrOfJoints());
    const auto n = static_cast<Eigen::Index>(made.motors.size() + made.free.size());
    A_.setZero(joints, n);
    b_.setZero(joints);
    damping_.setZero(joints);
    for (const auto& [name, segment] : tree_.getSegments()) {
      const KDL::Joint& joint = segment.segment.getJoint();
      if (joint.getType() != KDL::Joint::Fixed)
        add_row(GetTreeElementQNr(segment), *model_->getJoint(joint.getName()), made);
    }
  }

  Eigen::Vector3d tip(const Eigen::VectorXd& psi) const {
    KDL::TreeFkSolverPos_recursive solver(tree_);
    KDL::Frame frame;
    EXPECT_GE(solver.JntToCart(array(A_ * psi + b_), frame, tip_), 0);
    return {frame.p.x(), frame.p.y(), frame.p.z()};
  }

  Eigen::MatrixXd mass_matrix(const Eigen::VectorXd& psi) const {
    Eigen::MatrixXd M(A_.rows(), A_.cols());
    for (Eigen::Index i = 0; i < A_.cols(); ++i)
      M.col(i) = torques(KDL::Vector::Zero(), A_ * psi + b_, Eigen::VectorXd::Zero(A_.rows()), A_.col(i));
    return A_.transpose() * M;
  }

  Eigen::VectorXd bias(const Eigen::VectorXd& psi, const Eigen::VectorXd& psid) const {
    const Eigen::VectorXd qd = A_ * psid;
    return A_.transpose() * (torques({0, 0, -9.81}, A_ * psi + b_, qd, Eigen::VectorXd::Zero(A_.rows())) +
                             damping_.cwiseProduct(qd));
  }

 private:
  static KDL::JntArray array(const Eigen::VectorXd& values) {
    KDL::JntArray array(static_cast<unsigned>(values.size()));
    array.data = values;
    return array;
  }

  Eigen::VectorXd torques(const KDL::Vector& gravity, const Eigen::VectorXd& q, const Eigen::VectorXd& qd,
                          const Eigen::VectorXd& qdd) const {
    KDL::TreeIdSolver_RNE solver(tree_, gravity);
    KDL::JntArray torques(tree_.getNrOfJoints());
    EXPECT_GE(solver.CartToJnt(array(q), array(qd), array(qdd), {}, torques), 0);
    return torques.data;
  }

  void add_row(unsigned row, const urdf::Joint& joint, const Imported& made) {
    if (joint.dynamics) damping_[row] = joint.dynamics->damping;
    double slope = 1;
    const urdf::Joint* at = &joint;
    for (; at->mimic; at = model_->getJoint(at->mimic->joint_name).get()) {
      b_[row] += slope * at->mimic->offset;
      slope *= at->mimic->multiplier;
    }
    std::string name = at->name;
    for (const auto& [from, to] : made.renamed)
      if (from == name) name = to;
    std::vector<std::string> psi = made.motors;
    psi.insert(psi.end(), made.free.begin(), made.free.end());
    const auto found = std::find(psi.begin(), psi.end(), name);
    ASSERT_NE(found, psi.end()) << name;
    A_(row, found - psi.begin()) = slope;
  }

  urdf::ModelInterfaceSharedPtr model_;
  KDL::Tree tree_;
  std::string tip_;
  Eigen::MatrixXd A_;
  Eigen::VectorXd b_, damping_;
};

double size_of(const Eigen::MatrixXd& matrix) { return matrix.cwiseAbs().maxCoeff(); }

/// At seeded poses and rates, to 1e-12 of the largest element.
void expect_as_by_kdl(const Scene& scene, const ByKdl& kdl, unsigned seed) {
  const std::vector<double> parameters = scene.default_parameters();
  const auto model =
      make_model<double>(std::make_shared<const Scene>(scene), std::span<const double>(parameters));
  Workspace<double> ws(model);
  std::mt19937 chance(seed);
  std::uniform_real_distribution<double> position(-2, 2);
  const std::vector<double> zero(static_cast<std::size_t>(scene.n()), 0.0);
  for (int pose = 0; pose < 20; ++pose) {
    std::vector<double> psi(zero), psid(zero);
    for (double& value : psi) value = position(chance);
    for (double& value : psid) value = position(chance);
    const Eigen::VectorXd at = Eigen::Map<const Eigen::VectorXd>(psi.data(), scene.n()),
                          rate = Eigen::Map<const Eigen::VectorXd>(psid.data(), scene.n());
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", pose " << pose << ": " << at.transpose());
    const Eigen::Vector3d place = kdl.tip(at);
    EXPECT_LE((end_effector<double>(model, psi, zero, zero, 0.0, ws).position - place).norm(),
              1e-12 * std::max(1.0, place.norm()));
    const Eigen::MatrixXd M = kdl.mass_matrix(at);
    EXPECT_LE(size_of(mass_matrix<double>(model, psi, 0.0, ws) - M), 1e-12 * size_of(M));
    const Eigen::VectorXd h = kdl.bias(at, rate);
    EXPECT_LE(size_of(bias<double>(model, psi, psid, 0.0, ws) - h), 1e-12 * size_of(h));
  }
}

class ByKinematicsAndDynamicsLibrary : public testing::TestWithParam<const char*> {};

TEST_P(ByKinematicsAndDynamicsLibrary, TipMassMatrixAndBiasAreTheSame) {
  const std::string name = GetParam();
  const Imported made = imported_robot(name);
  expect_as_by_kdl(load_scene(parse_document(made.scene, name)), ByKdl(robot_file(name), made), 1);
}

TEST_P(ByKinematicsAndDynamicsLibrary, SoTheyAreOfEachLink) {
  const std::string name = GetParam();
  const auto model = urdf::parseURDFFile(robot_file(name));
  for (const auto& [link, said] : model->links_) {
    ImportOptions options;
    options.tip = link;
    try {
      const Imported made = imported_robot(name, options);
      expect_as_by_kdl(load_scene(parse_document(made.scene, name)), ByKdl(robot_file(name), made), 2);
    } catch (const InputError& error) {
      EXPECT_NE(error.message.find("no joint moves"), std::string::npos) << error.what();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, ByKinematicsAndDynamicsLibrary, testing::ValuesIn(kRobots),
                         [](const auto& robot) { return std::string(robot.param); });

TEST(ByKinematicsAndDynamicsLibrary, TheShippedUr5IsUniversalRobots) {
  const Imported made = imported_robot("ur5");
  expect_as_by_kdl(load_scene(std::filesystem::path(MIXLOOP_SCENES "/ur5.yaml")),
                   ByKdl(robot_file("ur5"), made), 3);
}

// By Denavit and Hartenberg's table, without the URDF's friction, and with a torch behind the flange.
TEST(ByKinematicsAndDynamicsLibrary, TheShippedPuma560IsAsMeasured) {
  const Imported made = imported_robot("puma_560");
  ByKdl kdl(robot_file("puma_560"), made);
  const auto scene =
      std::make_shared<const Scene>(load_scene(std::filesystem::path(MIXLOOP_SCENES "/puma_560.yaml")));
  const auto model = make_model<double>(scene, scene->default_parameters());
  Workspace<double> ws(model);
  const Eigen::VectorXd damping =
      Eigen::Map<const Eigen::VectorXd>(std::array<double, 6>{5.8, 9.5, 3.98, 0.412, 0.427, 0.216}.data(), 6)
          .eval();
  for (int pose = 0; pose < 5; ++pose) {
    std::vector<double> psi(6), psid(6);
    for (std::size_t i = 0; i < 6; ++i) {
      psi[i] = 2 * std::sin(1.0 + 3.1 * pose + 1.7 * static_cast<double>(i));
      psid[i] = std::cos(2.0 + 2.3 * pose + 0.9 * static_cast<double>(i));
    }
    const Eigen::VectorXd at = Eigen::Map<const Eigen::VectorXd>(psi.data(), 6),
                          rate = Eigen::Map<const Eigen::VectorXd>(psid.data(), 6);
    const Eigen::MatrixXd M = kdl.mass_matrix(at);
    EXPECT_LE(size_of(mass_matrix<double>(model, psi, 0.0, ws) - M), 1e-12 * size_of(M)) << pose;
    const Eigen::VectorXd h = kdl.bias(at, rate) - damping.cwiseProduct(rate);
    EXPECT_LE(size_of(bias<double>(model, psi, psid, 0.0, ws) - h), 1e-12 * size_of(h)) << pose;
    const auto& frame = ws.frames[static_cast<std::size_t>(scene->end_effector.frame)].T_0;
    EXPECT_LE((frame.col(3) - kdl.tip(at)).norm(), 1e-12) << pose;
  }
}

}  // namespace
}  // namespace mixloop
