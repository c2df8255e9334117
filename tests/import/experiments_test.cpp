// SPDX-License-Identifier: MIT
// The experiment that an import writes runs as it stands, and holds.
#include <gmock/gmock.h>

#include "tests/import/robots.hpp"
#include "tests/support/command.hpp"
#include "tests/support/simulated.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

class ItsExperiment : public testing::TestWithParam<const char*> {};

TEST_P(ItsExperiment, Holds) {
  const Imported made = imported_robot(GetParam());
  const ScratchFolder folder;
  folder.write(made.name + ".scene.yaml", made.scene);
  const std::string file = folder.write(made.name + ".experiment.yaml", made.experiment);
  Experiment experiment = load_experiment(std::filesystem::path(file), {});
  experiment.evaluation = Evaluation::interpreter;
  const Measures measures = simulated(experiment);
  EXPECT_FALSE(measures.diverged_at);
  ASSERT_TRUE(measures.max_motor_error);
  EXPECT_LT(measures.max_motor_error->maxCoeff(), 3e-3);
}

// One of each kind: mimic joints and a slide, damping that is faster than a tick, an effort too small for the
// weight, continuous joints, a floating base. `mixloop track` takes the others, too.
INSTANTIATE_TEST_SUITE_P(Robots, ItsExperiment,
                         testing::Values("gripper", "panda", "puma_560", "baxter_arm", "gen3",
                                         "mini_cheetah_leg"),
                         [](const auto& robot) { return std::string(robot.param); });

TEST(Experiment, HoldsTheRobotsLimits) {
  EXPECT_THAT(imported_robot("panda").experiment,
              HasSubstr("limits:\n"
                        "  position:\n"
                        "    - [-2.8973 rad, 2.8973 rad]   # panda_joint1\n"));
  const std::string gen3 = imported_robot("gen3").experiment;
  EXPECT_THAT(gen3, HasSubstr("    - [-1e9 rad, 1e9 rad]   # joint_1: none\n"
                              "    - [-2.41 rad, 2.41 rad]   # joint_2\n"));
  EXPECT_THAT(gen3, HasSubstr("  torque: [39 N m, 39 N m, 39 N m, 39 N m, 9 N m, 9 N m, 9 N m]\n"));
}

TEST(Experiment, NarrowsAMotorsLimitsToThoseOfTheJointsThatMimicIt) {
  // The knuckle may turn from 0 to 0.8 rad and by 2 rad/s; the finger, -knuckle - 0.05, from -0.9 to 0.1 rad;
  // the slide, 0.025 m * knuckle + 1 mm, to 30 mm: 1.16 rad.
  EXPECT_THAT(imported_robot("gripper").experiment, HasSubstr("    - [0, 0.8 rad]   # left_knuckle_joint\n"
                                                              "  velocity: [2 rad/s]\n"
                                                              "  torque: [5 N m]\n"));
  std::string text = bytes_of(robot_file("gripper"));
  const std::string slower = R"(lower="-0.02" upper="0.03" velocity="0.5")";
  text.replace(text.find(slower), slower.size(), R"(lower="-0.02" upper="0.011" velocity="0.025")");
  EXPECT_THAT(import_urdf(text, "gripper.urdf", {}).experiment,
              testing::AllOf(HasSubstr("    - [0, 0.3999999999999"), HasSubstr("  velocity: [1 rad/s]\n")));
}

TEST(Experiment, TakesStepsThatTheJointsDampingAsksFor) {
  EXPECT_THAT(imported_robot("puma_560").experiment, HasSubstr("substeps: 3}"));
  EXPECT_THAT(imported_robot("puma_560").experiment, HasSubstr("feedforward_at: desired"));
  EXPECT_THAT(imported_robot("ur5").experiment, HasSubstr("plant: {integrator: rk4, control: held}\n"));
}

TEST(Experiment, LeavesOutAnEffortThatIsTooSmallForTheWeight) {
  // Baxter's stretched arm weighs 52.9 N m on the second joint, whose effort is 50 N m.
  const Imported made = imported_robot("baxter_arm");
  EXPECT_THAT(made.experiment,
              HasSubstr("torque: [50 N m, 1e9 N m, 50 N m, 50 N m, 15 N m, 15 N m, 15 N m]"));
  bool is_listed = false;
  for (const auto& kind : made.left.kinds())
    is_listed =
        is_listed ||
        text_of(kind) == "limits of effort that the weight alone comes too near to, of the joints: right_s1";
  EXPECT_TRUE(is_listed);
}

TEST(Experiment, OfWhatMovesFreelyExpectsNothing) {
  ImportOptions options;
  options.free = {"pole"};
  const std::string text = imported_robot("cart_pole", options).experiment;
  EXPECT_THAT(text, HasSubstr("position_error: 1 km"));
  EXPECT_THAT(text, testing::Not(HasSubstr("expect")));
}

}  // namespace
}  // namespace mixloop
