// SPDX-License-Identifier: MIT
// The planar four-bar linkage in Simbody: the coupler's end stays in two planes of the rocker, which is the
// closure without a redundant row.
#include <Simbody.h>

#include <memory>

#include "bench/closed_engine.hpp"

namespace mixloop::bench {
namespace {

using namespace SimTK;

class SimbodyFourBar {
 public:
  SimbodyFourBar()
      : matter_(system_),
        forces_(system_),
        gravity_(forces_, matter_, Vec3(0, -9.81, 0)),
        torques_(forces_, matter_) {
    crank_ = MobilizedBody::Pin(matter_.Ground(), Transform(), bar(1, 0.3, 0.01), Transform());
    coupler_ = MobilizedBody::Pin(crank_, Transform(Vec3(0.3, 0, 0)), bar(2, 0.9, 0.05), Transform());
    rocker_ =
        MobilizedBody::Pin(matter_.Ground(), Transform(Vec3(1, 0, 0)), bar(1.5, 0.8, 0.04), Transform());
    Constraint::PointInPlane(rocker_, UnitVec3(1, 0, 0), 0.8, coupler_, Vec3(0.9, 0, 0));
    Constraint::PointInPlane(rocker_, UnitVec3(0, 1, 0), 0, coupler_, Vec3(0.9, 0, 0));
    system_.realizeTopology();
    state_ = system_.getDefaultState();
    system_.realizeModel(state_);
  }

  void forward(const ClosedState& state, double* psidd) {
    Vector& q = state_.updQ();
    Vector& u = state_.updU();
    q[0] = state.psi[0], q[1] = state.q[0], q[2] = state.q[1];
    u[0] = state.psid[0], u[1] = state.qd[0], u[2] = state.qd[1];
    torques_.setOneMobilityForce(state_, crank_, MobilizerUIndex(0), state.tau[0]);
    system_.realize(state_, Stage::Acceleration);
    psidd[0] = state_.getUDot()[0];
  }

 private:
  /// Along x from its hinge, slender, with this inertia about its centre.
  static Body::Rigid bar(double mass, double length, double inertia) {
    const Vec3 centre(length / 2, 0, 0);
    return Body::Rigid(
        MassProperties(mass, centre, Inertia(0, inertia, inertia).shiftFromMassCenter(centre, mass)));
  }

  MultibodySystem system_;
  SimbodyMatterSubsystem matter_;
  GeneralForceSubsystem forces_;
  Force::UniformGravity gravity_;
  Force::DiscreteForces torques_;
  MobilizedBody crank_, coupler_, rocker_;
  SimTK::State state_;
};

}  // namespace

void add_simbody_four_bar(ClosedEngines& engines) {
  const auto linkage = std::make_shared<SimbodyFourBar>();
  engines.push_back({"Simbody 3.7, a point in two planes", 1e-9,
                     [linkage](const ClosedState& state, double* psidd) { linkage->forward(state, psidd); }});
}

}  // namespace mixloop::bench
