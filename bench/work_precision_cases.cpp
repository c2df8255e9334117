// SPDX-License-Identifier: MIT
// What is integrated.
#include <cmath>

#include "bench/work_precision.hpp"
#include "dynamics/assembly/load_scene.hpp"

namespace mixloop::bench {
namespace {

Experiment experiment_named(const char* file) {
  return load_experiment(std::filesystem::path(MIXLOOP_EXPERIMENTS) / file, {});
}

Experiment of_scene(const NodePtr& document, double rate_hz) {
  Experiment experiment;
  experiment.scene = std::make_shared<const Scene>(load_scene(document));
  experiment.parameters = experiment.plant_parameters = experiment.scene->default_parameters();
  experiment.rate_hz = rate_hz;
  return experiment;
}

NodePtr papers_robot() {
  return read_document(std::filesystem::path(MIXLOOP_SCENES) / "mixed_loop_robot.yaml");
}

/// Six revolute joints of a Puma's shape, bodies of decreasing size.
constexpr const char* kSerialArm = R"(
name: six-axis arm
motors: [p1, p2, p3, p4, p5, p6]
coordinates: [q1, q2, q3, q4, q5, q6]
constraints: {q1: p1, q2: p2, q3: p3, q4: p4, q5: p5, q6: p6}
transforms:
  - {from: 0, to: 1, theta: q1, s: 0.67, alpha: 90 deg}
  - {from: 1, to: 2, theta: q2, a: 0.43}
  - {from: 2, to: 3, theta: q3, s: 0.15, a: 0.02, alpha: -90 deg}
  - {from: 3, to: 4, theta: q4, s: 0.43, alpha: 90 deg}
  - {from: 4, to: 5, theta: q5, alpha: -90 deg}
  - {from: 5, to: 6, theta: q6, s: 0.06}
bodies:
  - {frame: 1, mass: 8 kg, center_of_mass: [0, -0.1, 0.02], inertia: {xx: 0.3, yy: 0.2, zz: 0.3}}
  - {frame: 2, mass: 17 kg, center_of_mass: [-0.2, 0.01, 0.2], inertia: {xx: 0.13, yy: 0.5, zz: 0.5}}
  - {frame: 3, mass: 5 kg, center_of_mass: [0, -0.07, 0.14], inertia: {xx: 0.07, yy: 0.07, zz: 0.02}}
  - {frame: 4, mass: 1 kg, center_of_mass: [0, 0.02, 0], inertia: {xx: 0.004, yy: 0.003, zz: 0.004}}
  - {frame: 5, mass: 0.4 kg, center_of_mass: [0, 0, 0.03], inertia: {xx: 0.002, yy: 0.002, zz: 0.001}}
  - {frame: 6, mass: 0.5 kg, center_of_mass: [0, 0, 0.05], inertia: {xx: 0.003, yy: 0.003, zz: 0.002}}
gravity: [0, 0, -9.81 m/s^2]
end_effector: {frame: 6}
)";

Case free_swing() {
  Case free{.name = "free", .title = "the robot let go at the path's start, 3 s in pieces of 10 ms"};
  free.experiment = of_scene(papers_robot(), 100);
  const Experiment paper = experiment_named("paper.yaml");
  const Vector start = make_plan(paper).at(0).psi;
  free.psi0.assign(start.begin(), start.end());
  free.psid0.assign(3, 0.0);
  free.smooth = true;
  free.ticks = 300;
  free.sample_every = 10;
  free.converged_steps[0] = 32;
  free.converged_steps[1] = 8;
  free.torque = [](int, std::span<double> tau) { std::fill(tau.begin(), tau.end(), 0.0); };
  return free;
}

Case serial_arm() {
  Case arm{.name = "serial", .title = "a six-axis arm under swinging torques, held over ticks of 1 ms, 1 s"};
  arm.experiment = of_scene(parse_document(kSerialArm, "serial arm"), 1000);
  arm.psi0 = {0.3, -0.8, 0.5, 0.2, 0.7, -0.4};
  arm.psid0.assign(6, 0.0);
  arm.papers_robot = false;
  arm.torque = [](int k, std::span<double> tau) {
    for (std::size_t i = 0; i < tau.size(); ++i)
      tau[i] = (i < 3 ? 20.0 : 0.2) * std::sin(0.006 * k * static_cast<double>(i + 1));
  };
  return arm;
}

/// Friction that brings the elbow to rest within a small part of a tick, and a spring beside it.
Case stiff() {
  Case stiff{
      .name = "stiff",
      .title =
          "the robot let go with a damper at q5 (4 kN m s/rad) and a spring at q2, 0.1 s in ticks of 1 ms"};
  NodePtr document = papers_robot();
  document = override_entry(document, "loads",
                            "[{coordinate: q5, damping: 4000 N m s/rad}, "
                            "{coordinate: q2, stiffness: 500 N m/rad, rest: 60 deg, damping: 1 N m s/rad}]");
  stiff.experiment = of_scene(document, 1000);
  const Case free = free_swing();
  stiff.psi0 = free.psi0;
  stiff.psid0.assign(3, 0.0);
  stiff.torque = free.torque;
  stiff.ticks = 100;
  stiff.sample_every = 10;
  stiff.papers_robot = false;
  stiff.smooth = true;
  stiff.converged_steps[0] = 64;
  stiff.converged_steps[1] = 32;
  return stiff;
}

/// A scene let go at home with these rates and torques, in pieces of `tick` s.
Case let_go(const char* file, double tick, int ticks, std::vector<double> psid0, std::vector<double> tau) {
  Case motion;
  motion.experiment = of_scene(read_document(std::filesystem::path(MIXLOOP_SCENES) / file), 1 / tick);
  motion.psi0 = motion.experiment.scene->home;
  motion.psid0 = std::move(psid0);
  motion.ticks = ticks;
  motion.papers_robot = false;
  motion.smooth = true;
  motion.torque = [tau](int, std::span<double> out) { std::copy(tau.begin(), tau.end(), out.begin()); };
  return motion;
}

Case beside_closed(Case motion, const char* name, const char* title, const char* closed) {
  motion.name = name;
  motion.title = title;
  motion.closed = std::make_shared<const Scene>(load_scene(std::filesystem::path(MIXLOOP_SCENES) / closed));
  return motion;
}

Case slider_crank() {
  Case motion = let_go("spatial_slider_crank.yaml", 0.01, 500, {6}, {0});
  motion.sample_every = 25;
  motion.converged_steps[0] = 32;
  motion.converged_steps[1] = 6;
  return beside_closed(std::move(motion), "slider_crank",
                       "the spatial slider-crank of IFToMM's family turns by itself for 5 s",
                       "slider_crank_closed.yaml");
}

Case double_four_bar() {
  Case motion = let_go("double_four_bar.yaml", 0.02, 500, {1}, {0});
  motion.sample_every = 25;
  motion.converged_steps[0] = 12;
  motion.converged_steps[1] = 3;
  return beside_closed(std::move(motion), "double_four_bar",
                       "the double four-bar linkage (IFToMM A02) turns by itself for 10 s",
                       "double_four_bar_closed.yaml");
}

Case seven_bodies() {
  Case motion = let_go("seven_bodies.yaml", 0.005, 6, {0}, {0.033});
  motion.name = "seven_bodies";
  motion.title = "the seven-body mechanism of the IVP test set, 0.03 s in pieces of 5 ms";
  motion.sample_every = 1;
  motion.by_multipliers = true;
  motion.converged_steps[0] = 1500;
  motion.converged_steps[1] = 300;
  return motion;
}

Case closed_loop(const char* file, const char* name, const char* title, Case::Drive drive) {
  Case loop{.name = name, .title = title, .drive = drive};
  loop.experiment = experiment_named(file);
  const Vector start = make_plan(loop.experiment).at(0).psi;
  loop.psi0.assign(start.begin(), start.end());
  loop.psid0.assign(3, 0.0);
  if (drive == Case::Drive::continuous) loop.converged_steps[0] = 6, loop.converged_steps[1] = 2;
  return loop;
}

}  // namespace

std::vector<Case> all_cases() {
  return {closed_loop("paper.yaml", "held", "the paper's closed loop, torque held over ticks of 1 ms, 1 s",
                      Case::Drive::closed_loop),
          closed_loop("paper_continuous.yaml", "continuous", "the same, control evaluated continuously",
                      Case::Drive::continuous),
          free_swing(),
          serial_arm(),
          stiff(),
          slider_crank(),
          double_four_bar(),
          seven_bodies()};
}

}  // namespace mixloop::bench
