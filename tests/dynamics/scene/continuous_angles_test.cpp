// SPDX-License-Identifier: MIT
// Angles from constraints go on through 180 degrees where their value counts.
#include "dynamics/scene/continuous_angles.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/procedure/procedure.hpp"

namespace mixloop {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// A crank whose angle comes back through atan2, and what reads it.
Scene crank(const std::string& home, const std::string& reader) {
  return load_scene(parse_document(fmt::format(R"(
motors: [psi]
coordinates: [crank, seen, other]
constraints:
  crank: psi
  seen: atan2(sin(psi), cos(psi))
  other: 2*seen + 10 deg
transforms:
  - {{from: 0, to: 1, theta: crank, a: 1 m}}
  - {{from: 0, to: 2, theta: other, a: 1 m}}
bodies: [{{frame: 1, mass: 1 kg}}]
end_effector: {{frame: 1, axes: [x]}}
home: {{psi: {}}}
{}
)",
                                               home, reader),
                                   "scene.yaml"));
}

double seen_at(const Scene& scene, double psi) {
  const auto shared = std::make_shared<const Scene>(scene);
  const std::vector<double> none;
  const auto model = make_model<double>(shared, std::span<const double>(none));
  Workspace<double> ws(model);
  coordinates<double>(model, std::span<const double>(&psi, 1), 0.0, ws);
  return ws.q[1];
}

TEST(ContinuousAngles, GoOnThroughHalfATurnWhereALoadReadsThem) {
  const Scene scene = crank("170 deg", "loads: [{coordinate: seen, stiffness: 1 N m/rad}]");
  ASSERT_EQ(counted_angles(scene).size(), 1U);
  for (double psi = 0; psi < 340; psi += 1)
    EXPECT_NEAR(seen_at(scene, psi * kTurn / 360), psi * kTurn / 360, 4e-15) << psi;
}

TEST(ContinuousAngles, CountThroughOtherCoordinatesAndBrokenMultiples) {
  EXPECT_EQ(counted_angles(crank("0", "loads: [{coordinate: other, stiffness: 1 N m/rad}]")).size(), 1U);
  EXPECT_TRUE(counted_angles(crank("0", "")).empty()) << "twice an angle jumps by whole turns";
  const Scene half = load_scene(parse_document(R"yaml(
motors: [psi]
coordinates: [seen]
constraints: {seen: "atan2(sin(psi), cos(psi))"}
transforms: [{from: 0, to: 1, theta: seen/2, a: 1 m}]
bodies: [{frame: 1, mass: 1 kg}]
end_effector: {frame: 1, axes: [x]}
)yaml",
                                               "scene.yaml"));
  EXPECT_EQ(counted_angles(half).size(), 1U) << "half of it jumps by half a turn";
}

// What counts not is written as it stands, and keeps its program.
TEST(ContinuousAngles, LeaveOthersAlone) {
  const Scene scene = crank("170 deg", "");
  const Formula& seen = scene.coordinates[1].constraint;
  EXPECT_EQ(seen.nodes.back().op, Formula::Operator::atan2);
  EXPECT_NEAR(seen_at(scene, 190 * kTurn / 360), -170 * kTurn / 360, 1e-15);
}

TEST(AngleWatch, TellsAJumpHalfATurnAwayFromHome) {
  const Scene scene = crank("170 deg", "loads: [{coordinate: seen, stiffness: 1 N m/rad}]");
  AngleWatch watch(scene, {});
  for (double degrees = 170; degrees < 350; ++degrees) {
    const double psi = degrees * kTurn / 360;
    EXPECT_EQ(watch.look(std::span(&psi, 1), 0), "") << degrees;
  }
  const double past = 351 * kTurn / 360;
  EXPECT_NE(watch.look(std::span(&past, 1), 0).find("'seen' jumps by a turn"), std::string::npos);
  EXPECT_FALSE(AngleWatch(crank("170 deg", ""), {}).needed());
}

// A formula that a load acts along is as a coordinate that a load acts at.
TEST(ContinuousAngles, GoOnInWhatALoadActsAlong) {
  const Scene scene = crank("170 deg", R"yaml(loads:
  - {along: "atan2(sin(psi), cos(psi)) - psi/2", stiffness: 1 N m/rad}
  - {along: "sin(seen)", stiffness: 1 N m/rad})yaml");
  ASSERT_EQ(counted_angles(scene).size(), 1U) << "a sine is of no wound angle";
  EXPECT_EQ(counted_angles(crank("170 deg", "loads: [{along: seen/2, stiffness: 1 N m/rad}]")).size(), 1U);
  const auto along = [&](double psi) {
    return evaluate<double>(scene.along_loads[0].along, [&](int) { return psi; });
  };
  for (const double degrees : {100.0, 170.0, 190.0, 300.0})
    EXPECT_NEAR(along(degrees * kTurn / 360), degrees * kTurn / 720, 4e-15) << degrees;
  AngleWatch watch(scene, {});
  for (double degrees = 170; degrees < 350; ++degrees) {
    const double psi = degrees * kTurn / 360;
    EXPECT_EQ(watch.look(std::span(&psi, 1), 0), "") << degrees;
  }
  const double past = 351 * kTurn / 360;
  const std::string jumped = watch.look(std::span(&past, 1), 0);
  EXPECT_EQ(jumped.find("what a load acts along (line "), 0U) << jumped;
}

// A parallelogram's pose would flip where x passes zero.
TEST(AngleWatch, TellsThePoleOfAQuotientsAtan) {
  const Scene scene = load_scene(parse_document(R"yaml(
motors: [psi]
coordinates: [seen]
constraints: {seen: atan(sin(psi)/cos(psi))}
transforms: [{from: 0, to: 1, theta: seen, a: 1 m}]
bodies: [{frame: 1, mass: 1 kg}]
end_effector: {frame: 1, axes: [x]}
)yaml",
                                                "scene.yaml"));
  AngleWatch watch(scene, {});
  for (double degrees = 0; degrees < 90; ++degrees) {
    const double psi = degrees * kTurn / 360;
    EXPECT_EQ(watch.look(std::span(&psi, 1), 0), "") << degrees;
  }
  const double past = 91 * kTurn / 360;
  EXPECT_NE(watch.look(std::span(&past, 1), 0).find("jumps by half a turn"), std::string::npos);
  EXPECT_TRUE(counted_angles(load_scene(parse_document(R"yaml(
motors: [psi]
coordinates: [seen]
constraints: {seen: atan(0.1*sin(psi)/2)}
transforms: [{from: 0, to: 1, theta: seen, a: 1 m}]
bodies: [{frame: 1, mass: 1 kg}]
end_effector: {frame: 1, axes: [x]}
)yaml",
                                                       "scene.yaml")))
                  .empty())
      << "a constant divisor";
}

}  // namespace
}  // namespace mixloop
