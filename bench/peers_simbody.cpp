// SPDX-License-Identifier: MIT
// The paper's robot in Simbody: with three coordinate couplers, and as an open tree whose mass matrix and
// bias the user projects with C.
#include <Simbody.h>

#include <memory>
#include <string>
#include <vector>

#include "bench/engine.hpp"
#include "bench/robot_tree.hpp"

namespace mixloop::bench {
namespace {

using namespace SimTK;

class SimbodyRobot {
 public:
  explicit SimbodyRobot(bool constrained)
      : matter_(system_),
        forces_(system_),
        gravity_(forces_, matter_, Vec3(0, 0, -kGravity)),
        torques_(forces_, matter_) {
    for (int i = 0; i < kJoints; ++i) {
      const TreeJoint& joint = kTree[i];
      const Transform link = link_frame(joint);
      const Vec3 centre = link * Vec3(joint.centre[0], joint.centre[1], joint.centre[2]);
      const Inertia about_centre =
          Inertia(joint.inertia[0], joint.inertia[1], joint.inertia[2]).reexpress(~link.R());
      MassProperties mass(joint.mass, centre, about_centre.shiftFromMassCenter(centre, joint.mass));
      if (i == kEndEffectorJoint) mass = with_payload(mass, link.p());
      const Body::Rigid body(mass);
      if (joint.parent < 0)
        joints_.push_back(MobilizedBody::Pin(matter_.Ground(), Transform(), body, Transform()));
      else
        joints_.push_back(MobilizedBody::Pin(joints_[static_cast<std::size_t>(joint.parent)],
                                             link_frame(kTree[joint.parent]), body, Transform()));
    }
    if (constrained) {
      couple(2, 2, -2);
      couple(4, 1, -1);
      couple(5, -1, 1);
    }
    system_.realizeTopology();
    state_ = system_.getDefaultState();
    system_.realizeModel(state_);
  }

  /// Simbody's own constrained forward dynamics.
  void constrained(const bench::State& state, Triple& psidd) {
    place(state);
    const auto torque = basis_torque(state.tau);
    torques_.setOneMobilityForce(state_, joints_[0], MobilizerUIndex(0), torque[0]);
    torques_.setOneMobilityForce(state_, joints_[1], MobilizerUIndex(0), torque[1]);
    torques_.setOneMobilityForce(state_, joints_[3], MobilizerUIndex(0), torque[2]);
    system_.realize(state_, Stage::Acceleration);
    const auto& udot = state_.getUDot();
    psidd = motor_acceleration(udot[0], udot[1], udot[3]);
  }

  void projected(const bench::State& state, Triple& psidd) {
    place(state);
    system_.realize(state_, Stage::Dynamics);
    const Mat33 M = mass();
    const Vector rest(kJoints, 0.0);
    matter_.calcResidualForceIgnoringConstraints(
        state_, rest, system_.getRigidBodyForces(state_, Stage::Dynamics), rest, bias_);
    Vec3 force(state.tau[0], state.tau[1], state.tau[2]);
    for (int i = 0; i < kJoints; ++i)
      for (int j = 0; j < 3; ++j) force[j] -= kCoupling[i][j] * bias_[i];
    const Vec3 result = M.invert() * force;
    psidd = {result[0], result[1], result[2]};
  }

  void mass_matrix(const bench::State& state, MassMatrix& upper) {
    place(state);
    system_.realize(state_, Stage::Position);
    const Mat33 M = mass();
    upper = {M(0, 0), M(0, 1), M(0, 2), M(1, 1), M(1, 2), M(2, 2)};
  }

 private:
  static Transform link_frame(const TreeJoint& joint) {
    return Transform(Rotation(joint.alpha, XAxis), Vec3(joint.a, 0, joint.s));
  }

  static MassProperties with_payload(const MassProperties& link, const Vec3& at) {
    const double mass = link.getMass() + kPayload;
    const Vec3 centre = (link.getMass() * link.getMassCenter() + kPayload * at) / mass;
    return MassProperties(mass, centre, link.getInertia() + Inertia(at, kPayload));
  }

  /// q[joint] - by_q2 q2 - by_q3 q3 - offset = 0.
  void couple(int joint, double by_q2, double by_q3) {
    Vector coefficients(4);
    coefficients[0] = 1, coefficients[1] = -by_q2, coefficients[2] = -by_q3,
    coefficients[3] = -kCouplingOffset[static_cast<std::size_t>(joint)];
    Array_<MobilizedBodyIndex> bodies;
    for (const int i : {joint, 1, 3})
      bodies.push_back(joints_[static_cast<std::size_t>(i)].getMobilizedBodyIndex());
    const Array_<MobilizerQIndex> coordinates(3, MobilizerQIndex(0));
    Constraint::CoordinateCoupler(matter_, new Function::Linear(coefficients), bodies, coordinates);
  }

  void place(const bench::State& state) {
    Vector& q = state_.updQ();
    Vector& u = state_.updU();
    for (int i = 0; i < kJoints; ++i) {
      q[i] = kCouplingOffset[static_cast<std::size_t>(i)], u[i] = 0;
      for (int j = 0; j < 3; ++j) {
        q[i] += kCoupling[i][j] * state.psi[j];
        u[i] += kCoupling[i][j] * state.psid[j];
      }
    }
  }

  Mat33 mass() {
    matter_.calcM(state_, M_);
    Mat33 projected(0);
    for (int i = 0; i < kJoints; ++i)
      for (int k = 0; k < kJoints; ++k)
        for (int j = 0; j < 3; ++j)
          for (int l = 0; l < 3; ++l) projected(j, l) += kCoupling[i][j] * M_(i, k) * kCoupling[k][l];
    return projected;
  }

  MultibodySystem system_;
  SimbodyMatterSubsystem matter_;
  GeneralForceSubsystem forces_;
  Force::UniformGravity gravity_;
  Force::DiscreteForces torques_;
  std::vector<MobilizedBody> joints_;
  SimTK::State state_;
  Matrix M_;
  Vector bias_;
};

}  // namespace

void add_simbody(Engines& engines) {
  const auto tree = std::make_shared<SimbodyRobot>(false), coupled = std::make_shared<SimbodyRobot>(true);
  Engine open;
  open.name = "Simbody 3.7, open tree, projected by the user";
  open.tolerance = 1e-10;
  open.forward = [tree](const State& state, Triple& psidd) { tree->projected(state, psidd); };
  open.mass = [tree](const State& state, MassMatrix& M) { tree->mass_matrix(state, M); };
  engines.push_back(std::move(open));
  Engine own;
  own.name = "Simbody 3.7, three coordinate couplers";
  own.tolerance = 1e-8;
  own.forward = [coupled](const State& state, Triple& psidd) { coupled->constrained(state, psidd); };
  engines.push_back(std::move(own));
}

}  // namespace mixloop::bench
