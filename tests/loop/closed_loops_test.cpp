// SPDX-License-Identifier: MIT
// The shipped mechanisms whose chains close, against closed forms by vectors: what motion takes, where
// experiments end, and what is planned through closures.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/equations.hpp"
#include "dynamics/procedure/constraints.hpp"
#include "loop/review.hpp"
#include "loop/simulate.hpp"
#include "tests/oracles/closed_loops.hpp"
#include "tests/support/simulated.hpp"

namespace mixloop {
namespace {

using oracle::Jet;
using oracle::VirtualWork;
using Vec = Eigen::VectorXd;
constexpr double kDegree = std::numbers::pi / 180;

struct ClosedLoop {
  const char* scene;
  VirtualWork::Placing placing;
  std::array<double, 3> gravity;
  Vec home;  ///< w near the scene's home
};

const ClosedLoop& closed_loop(const std::string& name) {
  static const std::vector<ClosedLoop> all{
      {"planar_3rrr",
       [](const auto& w) { return oracle::planar_3rrr(w); },
       {0, -9.81, 0},
       Eigen::Vector3d(0, 0, 0.17767)},
      {"delta_robot",
       [](const auto& w) { return oracle::delta_robot(w); },
       {0, 0, -9.81},
       Eigen::Vector3d(0, 0, -0.39654)},
      {"spatial_five_bar", oracle::spatial_five_bar, {0, -9.81, 0}, Vec::Constant(1, -60 * kDegree)},
      {"four_bar_chain", oracle::four_bar_chain, {0, -9.81, 0}, Vec::Constant(1, 60 * kDegree)}};
  for (const ClosedLoop& loop : all)
    if (name == loop.scene) return loop;
  throw std::logic_error("no closed form of " + name);
}

std::shared_ptr<const Scene> scene_named(const std::string& name) {
  return std::make_shared<const Scene>(load_scene(std::filesystem::path(MIXLOOP_SCENES) / (name + ".yaml")));
}

/// Angles within half a turn of others.
Vec wound(Vec angles, const Vec& near) {
  for (Eigen::Index i = 0; i < angles.size(); ++i)
    angles[i] = near[i] + std::remainder(angles[i] - near[i], 2 * std::numbers::pi);
  return angles;
}

Vec vector_of(std::span<const double> x) {
  return Eigen::Map<const Vec>(x.data(), static_cast<Eigen::Index>(x.size()));
}

std::span<const double> span_of_vector(const Vec& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

/// w at these positions of the motors, by Newton's method from w.
Vec placed(const VirtualWork& work, const Vec& psi, Vec w) {
  const Vec none = Vec::Zero(w.size());
  for (int i = 0; i < 12; ++i) {
    Eigen::MatrixXd slopes(psi.size(), w.size());
    for (Eigen::Index k = 0; k < w.size(); ++k)
      slopes.col(k) = work.motors(w, Vec::Unit(w.size(), k), none).psid;
    w -= slopes.fullPivLu().solve(Vec(wound(work.motors(w, none, none).psi, psi) - psi));
  }
  return w;
}

class ClosedLoops : public testing::TestWithParam<const char*> {};

// Roundings of some thousand operations, times condition numbers of some ten.
TEST_P(ClosedLoops, TakeTheEffortsOfVirtualWorkWithVectors) {
  const ClosedLoop& loop = closed_loop(GetParam());
  const VirtualWork work(loop.placing, loop.gravity);
  const auto scene = scene_named(loop.scene);
  const Vec home = vector_of(scene->home);
  for (const Evaluation how : {Evaluation::interpreter, Evaluation::reference}) {
    Equations::Workspace programs(
        equations_of(scene, how, {Purpose::inverse_dynamics, Purpose::forward_dynamics}),
        scene->default_parameters());
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int trial = 0; trial < 40; ++trial) {
      Vec w = loop.home, wd(w.size()), wdd(w.size());
      for (Eigen::Index i = 0; i < w.size(); ++i)
        w[i] += 0.06 * unit(random), wd[i] = unit(random), wdd[i] = 5 * unit(random);
      const auto motors = work.motors(w, wd, wdd);
      const Vec psi = wound(motors.psi, home), expected = work.inverse(w, wd, wdd);
      auto tau = programs.outputs(Purpose::inverse_dynamics), psidd = tau;
      ASSERT_EQ(programs.evaluate(
                    Purpose::inverse_dynamics,
                    {span_of_vector(psi), span_of_vector(motors.psid), span_of_vector(motors.psidd)}, tau),
                Status::ok);
      EXPECT_LT((vector_of(tau) - expected).norm(), 1e-11 * (1 + expected.norm())) << trial;
      ASSERT_EQ(programs.evaluate(
                    Purpose::forward_dynamics,
                    {span_of_vector(psi), span_of_vector(motors.psid), span_of_vector(expected)}, psidd),
                Status::ok);
      EXPECT_LT((vector_of(psidd) - motors.psidd).norm(), 1e-10 * (1 + motors.psidd.norm())) << trial;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, ClosedLoops,
                         testing::Values("planar_3rrr", "delta_robot", "spatial_five_bar", "four_bar_chain"),
                         [](const auto& row) { return std::string(row.param); });

/// Where the motors are after so many ticks of 1 ms, each with the torque of its beginning, by RK4 in w.
Vec moved(const VirtualWork& work, Vec w, Vec psi, const Vec& psid, std::int64_t ticks, int substeps,
          const std::function<Vec(const Vec& psi, const Vec& psid)>& torque) {
  const Vec none = Vec::Zero(w.size());
  w = placed(work, psi, w);
  Eigen::MatrixXd slopes(psi.size(), w.size());
  for (Eigen::Index k = 0; k < w.size(); ++k)
    slopes.col(k) = work.motors(w, Vec::Unit(w.size(), k), none).psid;
  Vec wd = slopes.fullPivLu().solve(psid);
  const double h = 1e-3 / substeps;
  Vec tau;
  for (std::int64_t i = 0; i < ticks * substeps; ++i) {
    if (i % substeps == 0) tau = torque(psi, work.motors(w, wd, none).psid);
    const auto acceleration = [&](const Vec& at, const Vec& rate) { return work.forward(at, rate, tau); };
    const Vec a = acceleration(w, wd), wd2 = wd + h / 2 * a, b = acceleration(w + h / 2 * wd, wd2),
              wd3 = wd + h / 2 * b, c = acceleration(w + h / 2 * wd2, wd3), wd4 = wd + h * c,
              d = acceleration(w + h * wd3, wd4);
    w += h / 6 * (wd + 2 * (wd2 + wd3) + wd4);
    wd += h / 6 * (a + 2 * (b + c) + d);
    psi = wound(work.motors(w, none, none).psi, psi);
  }
  return psi;
}

/// RK4's error falls with the fourth power: twice as fine a step tells what is left.
void hold_end(const std::string& name, const std::string& scene, const Vec& psid,
              const std::function<Vec(const Vec&, const Vec&)>& torque) {
  const ClosedLoop& loop = closed_loop(scene);
  const VirtualWork work(loop.placing, loop.gravity);
  const Experiment experiment = shipped_experiment(name);
  const Measures measures = simulated(experiment);
  ASSERT_TRUE(measures.final_psi);
  EXPECT_TRUE(missed(experiment.expect, measures).empty()) << missed(experiment.expect, measures).front();
  const auto& initial = experiment.plant.initial_psi;
  const Vec psi = vector_of(initial.empty() ? experiment.scene->home : initial);
  const Vec end = moved(work, loop.home, psi, psid, measures.ticks, 4, torque),
            coarse = moved(work, loop.home, psi, psid, measures.ticks, 2, torque);
  const double left = (end - coarse).norm() / 15;
  EXPECT_LT(left, 1e-9);
  EXPECT_LT((*measures.final_psi - end).norm(), 2 * left + 1e-11) << end.transpose();
}

TEST(ClosedLoopExperiments, ThePlanar3RrrEndsWhereVirtualWorkSays) {
  const Vec home = Eigen::Vector3d(90, -150, -30) * kDegree;
  hold_end("planar_3rrr_swing", "planar_3rrr", Eigen::Vector3d(1, 0, -1),
           [&](const Vec& psi, const Vec& psid) { return Vec(-20 * (psi - home) - 0.02 * psid); });
}

TEST(ClosedLoopExperiments, TheSpatialFiveBarEndsWhereVirtualWorkSays) {
  hold_end("spatial_five_bar_swing", "spatial_five_bar", Vec::Zero(1),
           [](const Vec&, const Vec&) { return Vec(Vec::Zero(1)); });
}

TEST(ClosedLoopExperiments, TheChainOfFourBarsEndsWhereVirtualWorkSays) {
  hold_end("four_bar_chain_swing", "four_bar_chain", Vec::Zero(1), [](const Vec& psi, const Vec& psid) {
    return Vec(Vec::Constant(1, 16 - 60 * (psi[0] - 60 * kDegree) - 0.2 * psid[0]));
  });
}

// The inverse kinematics goes through three closures; the arms' angles follow from circles.
TEST(ClosedLoopExperiments, ThePlanOfTheDeltaRobotsCircleIsTheInverseKinematicsByVectors) {
  const Experiment experiment = shipped_experiment("delta_circle");
  const Plan plan = make_plan(experiment);
  const ClosedLoop& loop = closed_loop("delta_robot");
  const VirtualWork work(loop.placing, loop.gravity);
  for (std::int64_t k = 0; k < plan.ticks(); k += 7) {
    const Reference desired = plan.at(k);
    const auto motors = work.motors(desired.position, desired.velocity, desired.acceleration);
    EXPECT_LT((motors.psi - desired.psi).norm(), 1e-11) << k;
    EXPECT_LT((motors.psid - desired.psid).norm(), 1e-10) << k;
    EXPECT_LT((motors.psidd - desired.psidd).norm(), 1e-8) << k;
  }
}

// A pose that isn't reached leaves the search where it was.
TEST(ClosedLoopExperiments, APoseOutOfReachIsForgotten) {
  const auto scene = scene_named("planar_3rrr");
  const auto model = make_model<double>(scene, std::span<const double>());
  Workspace<double> ws(model);
  coordinates<double>(model, scene->home, 0, ws);
  const Vec home = ws.q;
  const std::vector<double> far{scene->home[0] + 0.5, scene->home[1] - 0.9, scene->home[2] + 0.3};
  coordinates<double>(model, far, 0, ws);
  EXPECT_FALSE(ws.is_solved);
  EXPECT_FALSE(ws.q.allFinite());
  coordinates<double>(model, scene->home, 0, ws);
  ASSERT_TRUE(ws.is_solved);
  EXPECT_LT((ws.q - home).norm(), 1e-14);
}

// By counting it could not move.
TEST(ClosedLoopExperiments, TheSpatialFiveBarHasOneRowThatFollowsFromTheOthers) {
  const auto scene = scene_named("spatial_five_bar");
  ASSERT_EQ(scene->redundant_rows.size(), 1u);
  EXPECT_EQ(scene->blocks.size(), 1u);
  EXPECT_EQ(scene->blocks[0].rows.size(), 3u);
  // And holds all along: watched far from home.
  Equations::Workspace programs(equations_of(scene, Evaluation::interpreter, {Purpose::mass_matrix}),
                                scene->default_parameters());
  for (int k = 0; k < 100; ++k) {
    const std::vector<double> psi{(-60 - k) * kDegree};
    ASSERT_EQ(programs.closures().accept(psi, 0), Status::ok);
    EXPECT_LT(programs.closures().watch().residual, 1e-14);
  }
}

}  // namespace
}  // namespace mixloop
