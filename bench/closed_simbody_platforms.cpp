// SPDX-License-Identifier: MIT
// The planar 3-RRR and the delta robot in Simbody: two planes that a point stays in, rods of a length.
#include <Simbody.h>

#include <array>
#include <cmath>
#include <memory>

#include "bench/closed_engine.hpp"

namespace mixloop::bench {
namespace {

using namespace SimTK;

constexpr double kThird = 2 * 3.14159265358979323846 / 3;

/// Along x, slender.
Body::Rigid bar(double mass, double length) {
  const double inertia = mass * length * length / 12;
  const Vec3 centre(length / 2, 0, 0);
  return Body::Rigid(
      MassProperties(mass, centre, Inertia(0, inertia, inertia).shiftFromMassCenter(centre, mass)));
}

struct SimbodySystem {
  explicit SimbodySystem(const Vec3& pull)
      : matter(system), forces(system), gravity(forces, matter, pull), torques(forces, matter) {}
  void begin() {
    system.realizeTopology();
    state = system.getDefaultState();
    system.realizeModel(state);
  }

  MultibodySystem system;
  SimbodyMatterSubsystem matter;
  GeneralForceSubsystem forces;
  Force::UniformGravity gravity;
  Force::DiscreteForces torques;
  SimTK::State state;
};

class SimbodyPlanar3rrr : SimbodySystem {
 public:
  SimbodyPlanar3rrr() : SimbodySystem(Vec3(0, -9.81, 0)) {
    constexpr double crank = 0.25, rod = 0.35;
    const auto corner = [](std::size_t k) {
      const double at = static_cast<double>(k) * kThird - kThird * 1.25;
      return Vec3(std::cos(at), std::sin(at), 0);
    };
    for (std::size_t k = 0; k < 3; ++k) {
      cranks_[k] =
          MobilizedBody::Pin(matter.Ground(), Transform(0.5 * corner(k)), bar(2 * crank, crank), Transform());
      rods_[k] = MobilizedBody::Pin(cranks_[k], Transform(Vec3(crank, 0, 0)), bar(2 * rod, rod), Transform());
    }
    platform_ = MobilizedBody::Pin(rods_[0], Transform(Vec3(rod, 0, 0)),
                                   Body::Rigid(MassProperties(1.2, Vec3(0), Inertia(0.004, 0.004, 0.008))),
                                   Transform(0.12 * corner(0)));
    for (std::size_t k = 1; k < 3; ++k) {
      const Vec3 at = 0.12 * corner(k);
      Constraint::PointInPlane(platform_, UnitVec3(1, 0, 0), at[0], rods_[k], Vec3(rod, 0, 0));
      Constraint::PointInPlane(platform_, UnitVec3(0, 1, 0), at[1], rods_[k], Vec3(rod, 0, 0));
    }
    begin();
  }

  void forward(const ClosedState& at, double* psidd) {
    for (std::size_t k = 0; k < 3; ++k) {
      cranks_[k].setOneQ(state, 0, at.psi[k]), cranks_[k].setOneU(state, 0, at.psid[k]);
      rods_[k].setOneQ(state, 0, at.q[k] - at.psi[k]), rods_[k].setOneU(state, 0, at.qd[k] - at.psid[k]);
      torques.setOneMobilityForce(state, cranks_[k], MobilizerUIndex(0), at.tau[k]);
    }
    platform_.setOneQ(state, 0, at.q[3] - at.q[0]), platform_.setOneU(state, 0, at.qd[3] - at.qd[0]);
    system.realize(state, Stage::Acceleration);
    for (std::size_t k = 0; k < 3; ++k) psidd[k] = cranks_[k].getOneUDot(state, 0);
  }

 private:
  std::array<MobilizedBody, 3> cranks_, rods_;
  MobilizedBody platform_;
};

class SimbodyDelta : SimbodySystem {
 public:
  SimbodyDelta() : SimbodySystem(Vec3(0, 0, -9.81)) {
    constexpr double arm = 0.2, arm_mass = 0.3, half_rods = 0.06;
    platform_ = MobilizedBody::Translation(
        matter.Ground(), Transform(), Body::Rigid(MassProperties(0.88, Vec3(0), Inertia(1e-9))), Transform());
    const double centre = (arm_mass * arm / 2 + half_rods * arm) / (arm_mass + half_rods);
    const double about_hinge = arm_mass * arm * arm / 3 + half_rods * arm * arm;
    const Body::Rigid body(
        MassProperties(arm_mass + half_rods, Vec3(centre, 0, 0), Inertia(0, about_hinge, about_hinge)));
    for (std::size_t k = 0; k < 3; ++k) {
      const double at = static_cast<double>(k) * kThird;
      const Vec3 outward(std::cos(at), std::sin(at), 0);
      const Rotation side = Rotation(at, ZAxis) * Rotation(-kThird * 0.75, XAxis);
      arms_[k] = MobilizedBody::Pin(matter.Ground(), Transform(side, 0.16 * outward), body, Transform());
      Constraint::Rod(arms_[k], Vec3(arm, 0, 0), platform_, 0.04 * outward, 0.45);
    }
    begin();
  }

  void forward(const ClosedState& at, double* psidd) {
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      arms_[i].setOneQ(state, 0, at.psi[i]), arms_[i].setOneU(state, 0, at.psid[i]);
      platform_.setOneQ(state, k, at.q[i]), platform_.setOneU(state, k, at.qd[i]);
      torques.setOneMobilityForce(state, arms_[i], MobilizerUIndex(0), at.tau[i]);
    }
    system.realize(state, Stage::Acceleration);
    for (std::size_t k = 0; k < 3; ++k) psidd[k] = arms_[k].getOneUDot(state, 0);
  }

 private:
  std::array<MobilizedBody, 3> arms_;
  MobilizedBody platform_;
};

}  // namespace

void add_simbody_planar_3rrr(ClosedEngines& engines) {
  const auto robot = std::make_shared<SimbodyPlanar3rrr>();
  engines.push_back({"Simbody 3.7, points in two planes", 1e-9,
                     [robot](const ClosedState& state, double* psidd) { robot->forward(state, psidd); }});
}

void add_simbody_delta_robot(ClosedEngines& engines) {
  const auto robot = std::make_shared<SimbodyDelta>();
  engines.push_back({"Simbody 3.7, rods", 1e-9,
                     [robot](const ClosedState& state, double* psidd) { robot->forward(state, psidd); }});
}

}  // namespace mixloop::bench
