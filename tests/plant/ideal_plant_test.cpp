// SPDX-License-Identifier: MIT
// The ideal plant on any scalar: on doubles it is the plant, on wide floats it says how well that counts.
#include "plant/ideal_plant.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/procedure/procedure.hpp"
#include "plant/plant.hpp"
#include "plant/tick.hpp"
#include "tests/oracles/wide.hpp"
#include "tests/plant/rig.hpp"

namespace mixloop {
namespace {

using oracle::Wide;

/// The procedure as it stands.
template <class T>
struct Literal {
  Model<T> model;
  Workspace<T> workspace{model};

  struct Arguments {
    std::span<const T> psi, psid, tau;
    T t;
  };
  void evaluate(Purpose, const Arguments& at, std::span<T> out) {
    const auto& psidd = forward_dynamics<T>(model, at.psi, at.psid, at.tau, at.t, workspace);
    std::copy(psidd.begin(), psidd.end(), out.begin());
  }
};

template <class T>
IdealState<T> after(int ticks, const PlantSettings& settings) {
  const auto scene = std::make_shared<const Scene>(
      load_scene(std::filesystem::path(MIXLOOP_SCENES) / "mixed_loop_robot.yaml"));
  const auto values = scene->default_parameters();
  const std::vector<T> parameters(values.begin(), values.end()), home(scene->home.begin(), scene->home.end());
  IdealPlant<T, Literal<T>> plant(plant_model(settings, *scene, 1000),
                                  {make_model<T>(scene, std::span<const T>(parameters))});
  IdealState<T> state = state_at(plant.model(), std::span<const T>(home));
  for (int k = 0; k < ticks; ++k) {
    const std::vector<T> tau = {T(0.1 * std::sin(0.2 * k)), T(0.3), T(-0.1)};
    take_command(plant.model(), state, std::span<const T>(tau), plant);
    advance_tick(plant.model(), state, plant);
  }
  return state;
}

const PlantSettings kDelayed{.substeps = 2, .command_delay = 0.0024};

TEST(IdealPlant, OnDoublesIsThePlantToTheBit) {
  const auto scene = std::make_shared<const Scene>(
      load_scene(std::filesystem::path(MIXLOOP_SCENES) / "mixed_loop_robot.yaml"));
  Plant plant({plant_equations(scene, Evaluation::reference, kDelayed), scene->default_parameters()},
              kDelayed, 1000, scene->home);
  for (int k = 0; k < 50; ++k) {
    plant.command(std::array{0.1 * std::sin(0.2 * k), 0.3, -0.1});
    plant.advance();
  }
  EXPECT_TRUE(plant.state().motion == after<double>(50, kDelayed));
}

// 50 ticks of 2 steps of 4 stages, each to a few round-offs of states of up to 30.
TEST(IdealPlant, OnWideFloatsIsTheSameToRoundOff) {
  const auto narrow = after<double>(50, kDelayed);
  const auto wide = after<Wide>(50, kDelayed);
  EXPECT_EQ(wide.tick, narrow.tick);
  for (Eigen::Index i = 0; i < narrow.x.size(); ++i)
    EXPECT_NEAR(narrow.x[i], static_cast<double>(wide.x[i]), 400 * 30 * 2.3e-16) << i;
}

}  // namespace
}  // namespace mixloop
