// SPDX-License-Identifier: MIT
// Motors that turn and motors that slide have their own units, side by side.
#include <gmock/gmock.h>

#include "loop/experiment.hpp"
#include "loop/result.hpp"
#include "tests/support/bad_input.hpp"
#include "tests/support/command.hpp"
#include "tests/support/mixed_motors.hpp"

namespace mixloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Experiment slide_and_turn(const std::string& more) {
  const ScratchFolder folder;
  folder.write("scene.yaml", kMixedMotorsScene);
  const std::string file = folder.file("mixed.yaml");
  return load_experiment(parse_document(kMixedMotorsExperiment + more, "mixed.yaml"), file, {});
}

TEST(MixedMotors, HaveTheirOwnUnitsInExpectationsAndResults) {
  const Experiment experiment = slide_and_turn("expect: {max_torque: [1 N, 2 N m]}\n");
  Measures measures{.max_torque = Vector::Constant(2, 5)};
  EXPECT_THAT(missed(experiment.expect, measures),
              ElementsAre("max_torque[0] is 5 N; expected at most 1 N",
                          "max_torque[1] is 5 N m; expected at most 2 N m"));
  const Result result = result_of(experiment, measures, "simulate", Evaluation::interpreter, 1);
  EXPECT_THAT(result.run->torque_units, ElementsAre("N", "N m"));
}

TEST(MixedMotors, AreNoneOfAllsFaultWithAUnit) {
  for (const char* magnitude : {"1 N", "1 N m"}) {
    const auto error = input_error([&] {
      slide_and_turn(std::string("faults: [{at: 0, motor: all, kind: wrong, magnitude: ") + magnitude +
                     "}]\n");
    });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code, "wrong_dimension");
    EXPECT_EQ(error->place.line, 4);
  }
  const auto error =
      input_error([] { slide_and_turn("faults: [{at: 0, sensor: all, kind: wrong, magnitude: 1 mm}]\n"); });
  ASSERT_TRUE(error);
  EXPECT_THAT(error->message, HasSubstr("the rotary motor 'turn'"));
  for (const char* good :
       {"motor: all, kind: wrong, magnitude: 1", "motor: slide, kind: wrong, magnitude: 1 N",
        "motor: turn, kind: garbage, magnitude: 1 N m", "sensor: all, kind: slow, magnitude: 1 ms"})
    EXPECT_NO_THROW(slide_and_turn(std::string("faults: [{at: 0, ") + good + "}]\n")) << good;
}

TEST(Parameters, WithoutAUnitHaveThatOfWhereTheyStand) {
  const ScratchFolder folder;
  std::string scene = kMixedMotorsScene;
  scene.replace(scene.find("1 kg"), 4, "load");
  folder.write("scene.yaml", "parameters: {load: 1}\n" + scene);
  const auto with = [&](const std::string& parameters) {
    const std::string text = kMixedMotorsExperiment + parameters;
    return load_experiment(parse_document(text, "mixed.yaml"), folder.file("mixed.yaml"), {});
  };
  EXPECT_EQ(with("parameters: {load: 3000 kg}\n").parameters[0], 3000);
  EXPECT_EQ(with("parameters: {load: 3}\n").parameters[0], 3);
  const auto error = input_error([&] { with("parameters: {load: 3 m}\n"); });
  ASSERT_TRUE(error);
  EXPECT_THAT(error->message, HasSubstr("the parameter 'load' is a length (m); expected a mass (kg)"));
}

}  // namespace
}  // namespace mixloop
