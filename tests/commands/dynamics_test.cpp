// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <fstream>

#include "tests/support/command.hpp"
#include "tests/support/mixed_motors.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

// REFERENCES.md's state, on which two independent derivations agree to the digits shown.
TEST(DynamicsCommand, GivesTheReferenceStateToAllDigits) {
  Command command({bin("mixloop"), "dynamics", robot(), "--psi", "1,2,3", "--psid", "0.1,0.2,0.3", "--json"});
  ASSERT_EQ(command.wait(), 0) << command.err();
  const auto json = command.json();
  const double M[3][3] = {{2.86550198957870e-3, -3.29814230930174e-4, 4.53116513172736e-6},
                          {-3.29814230930174e-4, 8.44291084783174e-3, -7.56340623201794e-3},
                          {4.53116513172736e-6, -7.56340623201794e-3, 7.551323125e-3}};
  const double h[3] = {0.154094718617371, 1.39472952783717, -1.80565290181932};
  const double E[3] = {0.0109567571316184, 0.00137677281379405, 0.355576736892400};
  for (std::size_t i = 0; i < 3; ++i) {
    // 15 digits are printed; the small off-diagonal element is a difference of terms of 1e-3.
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(json["mass_matrix"][i][j], M[i][j], 1e-17);
    EXPECT_NEAR(json["bias"][i], h[i], 1e-14);
    EXPECT_NEAR(json["end_effector"]["position"][i], E[i], 1e-15);
  }
  for (const char* key : {"q", "constraint_jacobian", "psidd"}) EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["end_effector"]["jacobian"].size(), 3U);
}

TEST(DynamicsCommand, TakesParametersAndZeroForWhatIsOmitted) {
  Command command({bin("mixloop"), "dynamics", robot(), "--set", "parameters.payload=0 kg", "--json"});
  ASSERT_EQ(command.wait(), 0) << command.err();
  EXPECT_DOUBLE_EQ(command.json()["q"][0], 0.0);
}

TEST(DynamicsCommand, TakesEachMotorsOwnUnitAndNoOther) {
  const ScratchFolder folder;
  const std::string scene = folder.write("scene.yaml", kMixedMotorsScene);
  const auto with = [&](const std::string& option, const std::string& values) {
    std::vector<std::string> words = {bin("mixloop"), "dynamics", scene, option, values, "--json"};
    if (option != "--psi") words.insert(words.end(), {"--psi", "0.5 m, 0"});  // at 0 m nothing turns
    Command command(words);
    const int status = command.wait();
    return status == 0 ? std::string("taken") : command.json()["error"]["code"].get<std::string>();
  };
  EXPECT_EQ(with("--psi", "30 cm, 20 deg"), "taken");
  EXPECT_EQ(with("--psid", "30 cm/s, 1 rpm"), "taken");
  EXPECT_EQ(with("--tau", "1 N, 2 N m"), "taken");
  EXPECT_EQ(with("--tau", "1, 2"), "taken");
  for (const auto& [option, values] : {std::pair{"--psi", "30 kg, 0.4"},
                                       {"--psi", "20 deg, 30 cm"},
                                       {"--psi", "1, 0.4 s"},
                                       {"--psid", "1 m, 1"},
                                       {"--psid", "1, 1 m/s"},
                                       {"--tau", "1 kg, 3"},
                                       {"--tau", "1 N m, 1 N m"},
                                       {"--tau", "1 N, 1 N"}})
    EXPECT_EQ(with(option, values), "wrong_dimension") << option << ' ' << values;
}

TEST(DynamicsCommand, KeepsEachParametersUnit) {
  for (const char* command : {"dynamics", "explain", "compile"}) {
    Command refused({bin("mixloop"), command, robot(), "--set", "parameters.payload=3 m", "--json"});
    EXPECT_EQ(refused.wait(), 2) << command;
    EXPECT_EQ(refused.json()["error"]["where"], "--set parameters.payload:1:1") << command;
    EXPECT_EQ(refused.json()["error"]["message"],
              "the parameter 'payload' is a length (m); expected a mass (kg)");
  }
}

TEST(DynamicsCommand, RefusesAPoseWhereASpringHasNoDirection) {
  const std::string scene = testing::TempDir() + "slide_on_a_spring.yaml";
  std::ofstream(scene) << "motors: {x: linear}\ntransforms: [{from: 0, to: slide, prismatic: x}]\n"
                          "bodies: [{frame: slide, mass: 2 kg}]\nend_effector: {frame: slide, axes: [z]}\n"
                          "loads: [{between: [{frame: 0}, {frame: slide}], stiffness: 5 N/m, rest: 10 cm}]\n";
  Command meets({bin("mixloop"), "dynamics", scene, "--psi", "0", "--json"});
  ASSERT_EQ(meets.wait(), 2);
  EXPECT_EQ(meets.json()["error"]["code"], "not_finite");
  EXPECT_EQ(meets.json()["error"]["where"], "--psi");
  Command apart({bin("mixloop"), "dynamics", scene, "--psi", "0.3", "--json"});
  ASSERT_EQ(apart.wait(), 0);
  EXPECT_NEAR(apart.json()["psidd"][0], -0.5, 1e-15);
}

TEST(DynamicsCommand, RefusesAStateOfTheWrongSize) {
  Command command({bin("mixloop"), "dynamics", robot(), "--psi", "1,2", "--json"});
  ASSERT_EQ(command.wait(), 2);
  EXPECT_EQ(command.json()["error"]["where"], "--psi:1:1");
}

}  // namespace
}  // namespace mixloop
