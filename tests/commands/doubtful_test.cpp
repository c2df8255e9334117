// SPDX-License-Identifier: MIT
// Robots that came out wrong without a word: each is right now, or says what is doubtful, or is refused.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// A block of so many kilograms on a slide along z, at which these loads act.
void write_slide(const ScratchFolder& folder, const std::string& mass, const std::string& rest) {
  folder.write("slide.yaml", R"(
motors: {x: linear}
coordinates: [slide]
constraints: {slide: x}
transforms: [{from: 0, to: up, theta: 90 deg, alpha: 90 deg}, {from: up, to: block, s: slide}]
bodies: [{frame: block, mass: )" +
                                 mass + "}]\n" + rest + "\nend_effector: {frame: block, axes: [x]}\n");
}

nlohmann::json simulated(const std::string& file, const std::vector<std::string>& sets, int status = 0) {
  std::vector<std::string> words = {bin("mixloop"), "simulate", file, "--json"};
  for (const auto& set : sets) words.insert(words.end(), {"--set", set});
  Command command(words);
  EXPECT_EQ(command.wait(), status) << command.out() << command.err();
  return command.json();
}

std::string warnings_in(const nlohmann::json& result) { return result["warnings"].dump(); }

/// 1 kg on 1e6 N/m, let go at 10 mm: x = 10 mm cos(1000 t).
std::string stiff_spring(const ScratchFolder& folder) {
  write_slide(folder, "1 kg", "loads: [{coordinate: slide, stiffness: 1e6 N/m}]");
  return folder.write("stiff.yaml", R"(
scene: slide.yaml
path: {line: {from: [10 mm], to: [10 mm]}, duration: 1 s}
controller: {law: pd, kp: [0], kv: [0]}
limits: {position_error: 1 m}
)");
}

TEST(StiffSpring, ThatItsStepsDampIsWarnedOf) {
  ScratchFolder folder;
  const std::string said = warnings_in(simulated(stiff_spring(folder), {}));
  EXPECT_THAT(said, HasSubstr("rk4 with 1 step a tick of 1 ms is too coarse"));
  EXPECT_THAT(said, HasSubstr("oscillation of 1000 rad/s"));
  EXPECT_THAT(said, HasSubstr("plant.substeps: 4"));
}

TEST(StiffSpring, KeepsItsMotionByWhatIsNamedAndByAuto) {
  ScratchFolder folder;
  const double last = 0.01 * std::abs(std::cos(1000.0) - 1);
  for (const char* steps : {"plant.substeps=16", "plant.integrator=auto", "plant.integrator=gauss8"}) {
    SCOPED_TRACE(steps);
    const auto result = simulated(stiff_spring(folder), {steps});
    // 1000 radians of RK4 at 1/16: (1/16)^4 / 120 each; auto may add 1e-9 a tick of 10 m/s.
    EXPECT_NEAR(result["final_position_error"], last, 0.01 * 1000 * std::pow(16, -4) / 120 + 1e-6);
    EXPECT_THAT(warnings_in(result), testing::Not(HasSubstr("too coarse")));
  }
}

TEST(StiffSpring, IsMarginalWithoutALimitByItsController) {
  ScratchFolder folder;
  Command command({bin("mixloop"), "stability", stiff_spring(folder), "--json", "--poses", "2", "--set",
                   "plant.substeps=16"});
  EXPECT_EQ(command.wait(), 0) << command.err();
  const auto one = command.json()["cases"][0];
  EXPECT_EQ(one["verdict"], "marginal");
  EXPECT_TRUE(one["at_start"]["longest_tick"].is_null());
  EXPECT_TRUE(one["at_start"]["longest_delay"].is_null());
  EXPECT_THAT(one["warnings"], IsEmpty());
}

/// 2 kg on a slope that pulls by 9.81 N, held by 20 N of smooth friction: it creeps by 1 mm/s atanh(9.81 /
/// 20).
std::string slope(const ScratchFolder& folder) {
  write_slide(folder, "2 kg", "gravity: [4.905, 0, 0]");
  return folder.write("slope.yaml", R"(
scene: slide.yaml
path: {line: {from: [0], to: [0]}, duration: 10 s}
controller: {law: pd, kp: [0], kv: [0]}
plant: {actuators: {friction: {coulomb: 20 N, smooth: 1 mm/s}}}
limits: {position_error: 100 m}
)");
}

TEST(SlopeFriction, TooSteepForItsStepsIsWarnedOf) {
  ScratchFolder folder;
  for (const char* method : {"rk4", "dop853", "dormand_prince", "semi_implicit_euler", "gauss8"}) {
    SCOPED_TRACE(method);
    const bool lost = std::string(method) == "gauss8";  // its iteration finds nothing
    const auto result = simulated(slope(folder), {std::string("plant.integrator=") + method}, lost ? 3 : 0);
    EXPECT_THAT(warnings_in(result), HasSubstr(std::string(method) + " with 1 step a tick"));
    EXPECT_THAT(warnings_in(result), HasSubstr("pole at -10000 1/s"));
    EXPECT_THAT(warnings_in(result), testing::Not(HasSubstr("rodas"))) << "which wants ideal drives";
  }
}

TEST(SlopeFriction, CreepsAsItsLawSaysByAutoAndByWhatIsNamed) {
  ScratchFolder folder;
  const double creep = 10 * 1e-3 * std::atanh(9.81 / 20);
  for (const std::vector<std::string>& sets :
       {std::vector<std::string>{"plant.integrator=auto"}, {"plant.substeps=8"}}) {
    const auto result = simulated(slope(folder), sets);
    // The start, from rest, takes some time constants of 0.1 ms.
    EXPECT_NEAR(result["final_position_error"], creep, 1e-6);
    EXPECT_THAT(result["warnings"], IsEmpty());
  }
}

/// A rotor of 0.02 kg m^2 with a damper of 100 N m s/rad.
std::string damped_rotor(const ScratchFolder& folder) {
  folder.write("rotor.yaml", R"(
parameters: {Jr: 0.02 kg m^2}
motors: [psi]
coordinates: [q]
constraints: {q: psi}
transforms: [{from: 0, to: rotor, theta: q, a: 0.1 m}]
bodies: [{frame: rotor, mass: 0, inertia: {xx: Jr/2, yy: Jr/2, zz: Jr}}]
loads: [{coordinate: q, damping: 100 N m s/rad}]
end_effector: {frame: rotor, axes: [y]}
)");
  return folder.write("damped.yaml", R"(
scene: rotor.yaml
path: {line: {from: [0], to: [0.05]}, duration: 1 s}
controller: {law: computed_torque, kp: [2000 N m/rad], kv: [20 N m s/rad]}
)");
}

TEST(StiffDamper, PastTheMethodsLimitNamesWhatBearsIt) {
  ScratchFolder folder;
  const std::string said = warnings_in(simulated(damped_rotor(folder), {}, 3));
  EXPECT_THAT(said, HasSubstr("its pole at -5000 1/s grows 13.7"));
  EXPECT_THAT(said, HasSubstr("plant.substeps: 2, or plant.integrator: rodas4"));
  for (const char* steps : {"plant.substeps=4", "plant.integrator=rodas4"})
    EXPECT_EQ(simulated(damped_rotor(folder), {steps})["verdict"], "held") << steps;
}

TEST(StiffDamper, IsNotStableWhereTheSimulationGrows) {
  ScratchFolder folder;
  Command command({bin("mixloop"), "stability", damped_rotor(folder), "--json", "--poses", "2"});
  EXPECT_EQ(command.wait(), 1) << command.err();
  const auto one = command.json()["cases"][0];
  EXPECT_EQ(one["verdict"], "unstable");
  EXPECT_THAT(one["warnings"].dump(), HasSubstr("too coarse for the plant itself"));
}

// A pendulum whose only mass is a parameter: taken away, nothing is left to swing.
TEST(StabilityVariation, ThatIsImpossibleIsSaidAndTheOthersGoOn) {
  ScratchFolder folder;
  folder.write("pendulum.yaml", R"(
parameters: {bob: 1 kg}
motors: [psi]
coordinates: [q]
constraints: {q: psi/8}
transforms: [{from: 0, to: 1, alpha: 90 deg}, {from: 1, to: rod, theta: q - 90 deg, a: 0.5 m}]
bodies: [{frame: rod, mass: bob}]
end_effector: {frame: rod, axes: [x]}
home: {psi: 1}
)");
  const std::string file = folder.write("swing.yaml", R"(
scene: pendulum.yaml
path: {line: {from: [0.1], to: [0.2]}, duration: 1 s}
controller: {law: pd, kp: [1], kv: [0.1]}
)");
  Command command({bin("mixloop"), "stability", file, "--json", "--poses", "2", "--no-confirmation"});
  EXPECT_EQ(command.wait(), 0) << command.err();
  const auto cases = command.json()["cases"];
  ASSERT_EQ(cases.size(), 2U);
  EXPECT_EQ(cases[0]["verdict"], "stable");
  EXPECT_EQ(cases[1]["verdict"], "impossible");
  EXPECT_EQ(cases[1]["error"]["code"], "singular_mass");
  EXPECT_THAT(cases[1]["error"]["message"].get<std::string>(), HasSubstr("motor 'psi' moves no inertia"));
}

/// A wrist whose point mass lies on its axis.
std::string singular_wrist(const ScratchFolder& folder) {
  return folder.write("wrist.yaml", R"(
motors: [arm, wrist]
coordinates: [q1, q2]
constraints: {q1: arm, q2: wrist}
transforms: [{from: 0, to: 1, theta: q1, a: 1 m, alpha: 90 deg}, {from: 1, to: 2, theta: q2}]
bodies: [{frame: 1, mass: 1 kg}, {name: tool, frame: 2, mass: 1 kg, center_of_mass: [0, 0, 5 cm]}]
end_effector: {frame: 2, axes: [x, y]}
)");
}

TEST(SingularMassMatrix, IsRefusedByWhateverNeedsIt) {
  ScratchFolder folder;
  const std::string scene = singular_wrist(folder);
  const std::string file = folder.write("run.yaml", R"(
scene: wrist.yaml
path: {line: {from: [1, 0], to: [0.9, 0.1]}, duration: 1 s}
controller: {law: pd, kp: [1, 1], kv: [1, 1]}
)");
  for (const std::vector<std::string>& words : {std::vector<std::string>{"dynamics", scene},
                                                {"simulate", file},
                                                {"simulate", file, "--set", "plant.integrator=auto"},
                                                {"stability", file},
                                                {"run", file}}) {
    SCOPED_TRACE(words[0]);
    std::vector<std::string> line = {bin("mixloop")};
    line.insert(line.end(), words.begin(), words.end());
    Command command(line);
    EXPECT_EQ(command.wait(), 2);
    EXPECT_THAT(command.err(), HasSubstr("motor 'wrist' moves no inertia"));
    EXPECT_THAT(command.err(), HasSubstr("'tool'"));
    EXPECT_EQ(command.out(), "");
  }
}

TEST(SingularMassMatrix, OfOnePoseIsSaidThere) {
  ScratchFolder folder;
  const std::string scene = folder.write("lift.yaml", R"(
motors: [turn, lift]
coordinates: [q1, q2]
constraints: {q1: turn, q2: lift}
transforms: [{from: 0, to: 1, theta: q1, alpha: 90 deg}, {from: 1, to: 2, theta: q2, a: 1 m}]
bodies: [{frame: 2, mass: 1 kg}]
end_effector: {frame: 2, axes: [x, z]}
)");
  Command level({bin("mixloop"), "dynamics", scene, "--psi", "0, 10 deg"});
  EXPECT_EQ(level.wait(), 0) << level.err();
  Command up({bin("mixloop"), "dynamics", scene, "--psi", "0, 90 deg"});
  EXPECT_EQ(up.wait(), 2);
  EXPECT_THAT(up.err(), HasSubstr("singular at this pose: motor 'turn'"));
}

TEST(ControllersScene, MustHaveThePlantsMotorsInTheirOrder) {
  ScratchFolder folder;
  const auto scene = [&](const std::string& motors, const std::string& constraints) {
    return "motors: " + motors + "\ncoordinates: [q1, q2]\nconstraints: " + constraints + R"(
transforms: [{from: 0, to: 1, theta: q1, a: 1 m}, {from: 1, to: 2, theta: q2, a: 1 m}]
bodies: [{frame: 1, mass: 1 kg}, {frame: 2, mass: 1 kg}]
end_effector: {frame: 2, axes: [x, y]}
home: {elbow: 90 deg}
)";
  };
  folder.write("plant.yaml", scene("[shoulder, elbow]", "{q1: shoulder, q2: elbow}"));
  folder.write("turned.yaml", scene("[elbow, shoulder]", "{q1: shoulder, q2: elbow}"));
  const std::string file = folder.write("run.yaml", R"(
scene: plant.yaml
path: {line: {from: [1, 1], to: [1.1, 0.9]}, duration: 1 s}
controller: {law: computed_torque, kp: [100, 100], kv: [20, 20]}
)");
  EXPECT_EQ(simulated(file, {"controller.scene=plant.yaml"})["verdict"], "held");
  const auto refused = simulated(file, {"controller.scene=turned.yaml"}, 2);
  EXPECT_EQ(refused["error"]["code"], "other_motors");
  EXPECT_THAT(refused["error"]["message"].get<std::string>(),
              HasSubstr("elbow, shoulder, the plant's shoulder"));
}

/// A crank that starts at 170 deg and goes on through 180; a spring at its angle, taken from a vector by
/// atan2.
TEST(AnAngleByAtan2, GoesOnThroughHalfATurnWithTheEnergyOfItsSpring) {
  ScratchFolder folder;
  folder.write("crank.yaml", R"yaml(
motors: [psi]
coordinates: [crank, seen]
constraints: {crank: psi, seen: "atan2(sin(psi), cos(psi))"
}
transforms: [{from: 0, to: A, theta: crank, a: 1 m}]
bodies: [{frame: A, mass: 1 kg}]
loads: [{coordinate: seen, stiffness: 3 N m/rad, rest: 90 deg}]
end_effector: {frame: A, axes: [y]}
home: {psi: 170 deg}
)yaml");
  // y = sin(170 deg) to sin(200 deg)
  const std::string file = folder.write("run.yaml", R"(
scene: crank.yaml
path: {line: {from: [0.17364817766693], to: [-0.34202014332567]}, duration: 1 s}
controller: {law: computed_torque, kp: [100], kv: [20]}
)");
  Command command({bin("mixloop"), "simulate", file, "--json", "--out", folder.file("kept")});
  ASSERT_EQ(command.wait(), 0) << command.err();
  // What the motor worked is in motion and spring, at every tick; a jump of a turn would be 40 J.
  std::ifstream csv(folder.file("kept/trajectory.csv"));
  std::string header, line;
  std::getline(csv, header);
  const auto column = [&](const std::string& name) {
    const std::string before = header.substr(0, ("," + header + ",").find("," + name + ","));
    return std::count(before.begin(), before.end(), ',');
  };
  const auto kinetic = column("kinetic_energy"), potential = column("potential_energy"),
             work = column("work");
  std::vector<double> balance;
  while (std::getline(csv, line)) {
    std::istringstream fields(line);
    std::vector<double> values;
    for (std::string field; std::getline(fields, field, ',');) values.push_back(std::stod(field));
    const auto at = [&](std::ptrdiff_t i) { return values[static_cast<std::size_t>(i)]; };
    balance.push_back(at(kinetic) + at(potential) - at(work));
  }
  ASSERT_EQ(balance.size(), 1001U);
  for (const double energy : balance) ASSERT_NEAR(energy, balance[0], 1e-9);  // RK4's at 1 kHz is below 1e-12
  EXPECT_THAT(command.json()["warnings"], IsEmpty());

  // Half a turn from home, at 350 deg, it would jump.
  const auto refused =
      simulated(file,
                {"path={line: {from: [-0.34202014332567], to: [0.17364817766693]}, duration: 1 s}",
                 "scene.home={psi: -10 deg}", "plant.initial=[200 deg]"},
                2);
  EXPECT_EQ(refused["error"]["code"], "angle_jumps");
  EXPECT_THAT(refused["error"]["message"].get<std::string>(),
              HasSubstr("the coordinate 'seen' jumps by a turn"));
}

}  // namespace
}  // namespace mixloop
