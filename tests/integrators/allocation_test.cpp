// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "dynamics/assembly/load_scene.hpp"
#include "plant/plant.hpp"
#include "tests/support/allocation_counter.hpp"

namespace mixloop {
namespace {

class Ticks : public testing::TestWithParam<MethodFacts> {};

TEST_P(Ticks, AllocateNothing) {
  if (!AllocationCounter::works()) GTEST_SKIP() << "a sanitizer has its own malloc";
  const auto scene = std::make_shared<const Scene>(
      load_scene(std::filesystem::path(MIXLOOP_SCENES) / "mixed_loop_robot.yaml"));
  PlantSettings settings{.integrator = GetParam().method, .substeps = 2};
  for (const double local_error : {0.0, 1e-12}) {
    if (local_error > 0 && !GetParam().error_control) continue;
    settings.local_error = local_error;
    Plant plant(
        {equations_of(scene, Evaluation::interpreter, {Purpose::forward_dynamics, Purpose::linearisation}),
         scene->default_parameters()},
        settings, 1000, std::vector{1.0, 2.0, 3.0});
    const double tau[] = {0.1, 0.2, -0.1};
    const AllocationCounter counter;
    for (int k = 0; k < 5; ++k) {
      plant.command(tau);
      plant.advance();
    }
    EXPECT_EQ(counter.count(), 0U) << counter.first_caller();
    EXPECT_GT(plant.psid()[0], 0);
    if (!GetParam().jacobian && local_error == 0) {
      plant.advance_continuously([](int, double, auto, auto, std::span<double> out) { out[0] = 0.1; });
      EXPECT_EQ(counter.count(), 0U) << counter.first_caller();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Ticks, testing::ValuesIn(all_methods()),
                         [](const auto& row) { return std::string(row.param.name); });

}  // namespace
}  // namespace mixloop
