// SPDX-License-Identifier: MIT
// What is constant in poses folds away: mechanisms that are told by poses have the programs of those told by
// Denavit and Hartenberg's numbers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "certification.hpp"
#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/explanation/explanation.hpp"
#include "dynamics/program/interpreter.hpp"
#include "dynamics/program/trace.hpp"
#include "notation/document.hpp"

namespace mixloop::testing {
namespace {

std::shared_ptr<const Scene> posed(const std::string& text) {
  return std::make_shared<const Scene>(load_scene(parse_document(text, "posed")));
}

/// Table B-1, each row as a joint and, where its link has a length, the way to its end.
constexpr const char* kRobotsPoses = R"(transforms:
  - {from: 0, to: 1, at: [0, 0, L1], rpy: [90 deg, 0, 0], revolute: q1, axis: y}
  - {from: 1, to: shoulder, revolute: q2}
  - {from: shoulder, to: 2, at: [L2, 0, 0]}
  - {from: 2, to: elbow, revolute: q5}
  - {from: elbow, to: 3, at: [L3, 0, 0], rpy: [90 deg, 0, 0]}
  - {from: 1, to: crank, revolute: q3}
  - {from: crank, to: 4, at: [L4, 0, 0]}
  - {from: 4, to: rod, revolute: q6}
  - {from: rod, to: 5, at: [L5, 0, 0]}
  - {from: 5, to: rocker, revolute: q4}
  - {from: rocker, to: 6, at: [L6, 0, 0]}
)";

std::string shipped_robot() {
  std::ifstream file(MIXLOOP_SCENES "/mixed_loop_robot.yaml");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::shared_ptr<const Scene> posed_robot() {
  std::string text = shipped_robot();
  const auto from = text.find("transforms:"), to = text.find("# Table B-2");
  return posed(text.replace(from, to - from, kRobotsPoses));
}

std::vector<double> interpreted(const Program& program, const Scene& scene, const Sample& sample) {
  const Interpreter interpreter(program);
  Evaluator evaluator(interpreter);
  evaluator.set_up(scene.default_parameters());
  std::vector<double> out(program.outputs.size());
  EXPECT_EQ(evaluator.evaluate(sample.arguments(), out), Status::ok);
  return out;
}

/// Of one purpose the two scenes' outputs, within `tolerance` of the largest.
void expect_same_values(const std::shared_ptr<const Scene>& one, const Program& program_of_one,
                        const std::shared_ptr<const Scene>& other, const Program& program_of_other,
                        double tolerance, const std::string& what) {
  std::mt19937_64 random(1);
  for (int k = 0; k < 20; ++k) {
    const Sample sample = random_sample(*one, random);
    const auto x = interpreted(program_of_one, *one, sample),
               y = interpreted(program_of_other, *other, sample);
    ASSERT_EQ(x.size(), y.size());
    double size = 0;
    for (const double value : x) size = std::max(size, std::abs(value));
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], y[i], tolerance * size) << what;
  }
}

// Round-off: of angles up to hundreds of degrees, through M's condition number of up to 1000, twice in the
// linearisation.
TEST(PosePrograms, ThePapersRobotToldByPosesHasItsProgramsOperationForOperation) {
  const auto shipped = posed(shipped_robot()), poses = posed_robot();
  for (const Purpose purpose : kPurposes) {
    const TracedProgram one = trace(shipped, purpose), other = trace(poses, purpose);
    const std::string what(name_of(purpose));
    EXPECT_EQ(name_of(one.tracing), name_of(other.tracing)) << what;
    EXPECT_EQ(one.program.run_operations().text(), other.program.run_operations().text()) << what;
    EXPECT_EQ(one.program.set_up_operations().text(), other.program.set_up_operations().text()) << what;
    expect_same_values(shipped, one.program, poses, other.program, 1e-12, what);
  }
}

/// Six axes, none parallel, the last a slide.
std::string spatial_arm(bool by_poses) {
  const struct {
    double theta, d, a, alpha;
  } rows[] = {{10, 0.35, 0.05, 80}, {-20, 0.1, 0.3, 25}, {35, -0.1, 0.1, -70},
              {0, 0.25, 0, 90},     {15, 0, 0.05, -60},  {30, 0.2, 0.1, 40}};
  std::string transforms, bodies;
  for (int i = 0; i < 6; ++i) {
    const auto& [theta, d, a, alpha] = rows[i];
    const bool slides = i == 5;
    if (by_poses)
      transforms += fmt::format(
          "  - {{from: {0}, to: joint{1}, {2}}}\n  - {{from: joint{1}, to: {1}, at: [{3}, 0, {4}], rpy: [{5} "
          "deg, 0, "
          "0]}}\n",
          i, i + 1,
          slides ? fmt::format("rpy: [0, 0, {} deg], prismatic: q6", theta)
                 : fmt::format("revolute: q{} + {} deg", i + 1, theta),
          a, d, alpha);
    else
      transforms +=
          fmt::format("  - {{from: {}, to: {}, theta: {}{} deg, s: {}{}, a: {}, alpha: {} deg}}\n", i, i + 1,
                      slides ? "" : fmt::format("q{} + ", i + 1), theta, slides ? "q6 + " : "", d, a, alpha);
    bodies += fmt::format(
        "  - {{frame: {}, mass: {}, center_of_mass: [-0.1, 0.02, 0.03], inertia: {{xx: 0.02, yy: 0.03, zz: "
        "0.025, "
        "xy: 0.001}}}}\n",
        i + 1, 3.0 / (i + 1));
  }
  return "motors: {p1: rotary, p2: rotary, p3: rotary, p4: rotary, p5: rotary, p6: linear}\n"
         "coordinates: [q1, q2, q3, q4, q5, q6]\n"
         "constraints: {q1: p1, q2: p2, q3: p3, q4: p4/2, q5: p5, q6: p6}\n"
         "transforms:\n" +
         transforms + "bodies:\n" + bodies +
         "gravity: [0, 0, -9.81]\nend_effector: {frame: 6, point: [0.1, 0, 0]}\n";
}

// Bodies behind a fixed pose are lumped before the run: poses take fewer operations, if anything.
TEST(PosePrograms, ASpatialArmIsTheSameEitherWay) {
  const auto table = posed(spatial_arm(false)), poses = posed(spatial_arm(true));
  for (const Purpose purpose : {Purpose::forward_dynamics, Purpose::mass_matrix, Purpose::bias,
                                Purpose::end_effector, Purpose::energy, Purpose::inverse_dynamics})
    for (const Tracing tracing : {Tracing::recursive, Tracing::articulated}) {
      const Program one = trace(table, purpose, tracing), other = trace(poses, purpose, tracing);
      if (one.outputs.empty()) continue;  // the articulated one's
      const std::string what = fmt::format("{}, {}", name_of(purpose), name_of(tracing));
      EXPECT_LE(other.run_operations().flops(), one.run_operations().flops()) << what;
      EXPECT_EQ(other.run_operations().sincos, one.run_operations().sincos) << what;
      expect_same_values(table, one, poses, other, 1e-13, what);
    }
}

// What stands amid a pose is not said, nor counted.
TEST(PosePrograms, ExplanationsCountTransformsAsThePersonDid) {
  const auto sentence = [](const std::string& text) -> std::string {
    for (const auto& reason : explain(posed(text)).reasons)
      if (reason.find("leave the axis parallel") != std::string::npos) return reason;
    return "";
  };
  const std::string rest =
      "bodies: [{frame: b, mass: 1, center_of_mass: [0.5, 0, 0]}]\nend_effector: {frame: b}\nmotors: [p, q]\n"
      "transforms:\n  - {from: 0, to: a, at: [1, 2, 3], rpy: [90 deg, 0, 0], revolute: p}\n"
      "  - {from: a, to: b, at: [1, 2, 3], revolute: q}\n";
  EXPECT_EQ(sentence(rest).find("1 of 2 transforms"), 0U) << sentence(rest);
}

}  // namespace
}  // namespace mixloop::testing
