// SPDX-License-Identifier: MIT
// Other choices of independent coordinates.
#include "dynamics/assembly/partitions.hpp"

#include <gtest/gtest.h>

#include <set>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/equations.hpp"

namespace mixloop {
namespace {

Scene scene_named(const std::string& name) {
  return load_scene(std::filesystem::path(MIXLOOP_SCENES) / (name + ".yaml"));
}

TEST(Partitions, OfAFourBarAreItsThreeAngles) {
  const Scene scene = scene_named("four_bar_rocker");
  const auto partitions = partitions_of(scene);
  std::vector<std::string> names;
  for (const auto& partition : partitions) names.push_back(partition.scene->independent[0].name);
  EXPECT_EQ(names, (std::vector<std::string>{"rocker", "crank", "elbow"}));
  for (const auto& partition : partitions) {
    EXPECT_EQ(partition.scene->n_u(), 1) << "the motor stays";
    EXPECT_EQ(partition.scene->started.size(), 2U);
    for (int j = 0; j < scene.m(); ++j)
      EXPECT_NEAR(partition.scene->coordinates[static_cast<std::size_t>(j)].home,
                  scene.coordinates[static_cast<std::size_t>(j)].home, 1e-12)
          << "all at the same pose";
  }
}

// Each freedom for an unknown of a block that it moves, all that the platform's loops have.
TEST(Partitions, AreAsManyAsUnknownsThatAMotorMoves) {
  EXPECT_EQ(partitions_of(scene_named("four_bar_chain")).size(), 1U + 4 * 2);
  EXPECT_EQ(partitions_of(scene_named("seven_bodies")).size(), 1U + 3 * 2);
  EXPECT_EQ(partitions_of(scene_named("planar_3rrr")).size(), 1U + 3 * 4);
}

// M z'' + h = (d psi / d z)^T tau, by the programs and by the procedure on numbers.
TEST(Partitions, TakeTheMotorsForcesByVirtualWorkInProgramsAndProcedure) {
  for (const char* name : {"four_bar_rocker", "planar_3rrr", "slider_crank_closed", "delta_robot"}) {
    std::set<std::string> texts;
    for (const auto& partition : partitions_of(scene_named(name))) {
      const Scene& scene = *partition.scene;
      EXPECT_TRUE(texts.insert(scene.canonical).second) << "a text of its own";
      const auto workspace = [&](Evaluation how) {
        return Equations::Workspace(equations_of(partition.scene, how, {Purpose::forward_dynamics}),
                                    scene.default_parameters());
      };
      auto programs = workspace(Evaluation::interpreter), procedure = workspace(Evaluation::reference);
      std::vector<double> z = scene.home, zd, tau;
      for (std::size_t i = 0; i < z.size(); ++i) {
        z[i] += 0.003 * (1 + static_cast<double>(i));
        zd.push_back(0.3 - 0.2 * static_cast<double>(i));
        if (i < scene.motors().size()) tau.push_back(1 + static_cast<double>(i));
      }
      auto one = programs.outputs(Purpose::forward_dynamics), other = one;
      ASSERT_EQ(programs.evaluate(Purpose::forward_dynamics, {z, zd, tau}, one), Status::ok) << name;
      ASSERT_EQ(procedure.evaluate(Purpose::forward_dynamics, {z, zd, tau}, other), Status::ok) << name;
      for (std::size_t i = 0; i < one.size(); ++i)
        EXPECT_NEAR(one[i], other[i], 1e-9 * (1 + std::abs(other[i]))) << name << " " << partition.swapped;
    }
  }
}

}  // namespace
}  // namespace mixloop
