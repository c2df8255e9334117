// SPDX-License-Identifier: MIT
// A plant's state is a value: kept, compared, put back, it gives the same bytes again.
#include "plant/plant_state.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "loop/experiment.hpp"
#include "tests/plant/rig.hpp"

namespace mixloop {
namespace {

struct Case {
  const char* name;
  PlantSettings settings;
};
void PrintTo(const Case& it, std::ostream* out) { *out << it.name; }

SensorSettings all_sensors() {
  return {.resolution = {1e-3, 1e-3},
          .noise = {1e-3, 1e-3},
          .bias = {0.1, 0},
          .delay = {2, 7},
          .drop = {0.1, 0.3},
          .differentiated = true,
          .velocity_filter = 100};
}

ActuatorSettings all_drives() {
  return {.rate_limit = {100, 30},
          .time_constant = {0.003, 0},
          .ripple = {0.1, 0},
          .ripple_per_turn = {6, 1},
          .viscous = {0.1, 0.1},
          .coulomb = {0.1, 0.1},
          .smooth = {1, 1}};
}

FaultSettings all_faults() {
  return {.scheduled =
              {{.kind = Fault::Kind::delayed, .index = 0, .magnitude = 0.005, .at = 0.09, .duration = 0.03},
               {.kind = Fault::Kind::garbage, .index = 1, .magnitude = 2, .at = 0.05},
               {.target = Fault::Target::sensor, .kind = Fault::Kind::slow, .magnitude = 0.01, .at = 0.08},
               {.target = Fault::Target::parameter,
                .kind = Fault::Kind::changed,
                .index = 0,
                .magnitude = 3,
                .at = 0.07},
               {.target = Fault::Target::friction, .kind = Fault::Kind::changed, .magnitude = 2, .at = 0.095},
               {.kind = Fault::Kind::stuck, .at = 0.15, .duration = 0.01}},
          .injected = true};
}

std::vector<Case> cases() {
  std::vector<Case> all = {
      {"Ideal", {}},
      {"Saturated", {.torque_limit = {0.5, 0.5}}},
      {"Delayed", {.command_delay = 0.0034}},
      {"ErrorControlled", {.integrator = Method::dop853, .local_error = 1e-10}},
      {"Rosenbrock", {.integrator = Method::rodas4, .substeps = 2}},
      {"Iterating", {.integrator = Method::gauss8}},
      {"Measured", {.sensors = all_sensors()}},
      {"Driven", {.actuators = all_drives()}},
      {"Faulty", {.faults = all_faults()}},
  };
  PlantSettings everything{
      .integrator = Method::dormand_prince, .local_error = 1e-9, .command_delay = 0.0016};
  everything.sensors = all_sensors();
  everything.actuators = all_drives();
  everything.faults = all_faults();
  all.push_back({"AllAtOnce", everything});
  return all;
}

/// Goes on by ticks of a course of commands, injected faults among them; all that can be seen on the way.
std::vector<double> course(Plant& plant, int ticks) {
  std::vector<double> seen;
  const auto see = [&](std::span<const double> values) {
    seen.insert(seen.end(), values.begin(), values.end());
  };
  for (int i = 0; i < ticks; ++i) {
    const auto k = static_cast<double>(plant.tick());
    double psi[2], psid[2];
    seen.push_back(plant.measure(psi, psid));
    if (plant.tick() % 40 == 30) plant.inject({.kind = Fault::Kind::off, .duration = 0.002});
    const double tau[] = {std::sin(0.1 * k) - 0.1 * psi[0], std::cos(0.3 * k) - 0.2 * psid[1]};
    plant.command(tau);
    for (const auto values : {std::span<const double>(psi), std::span<const double>(psid), plant.applied()})
      see(values);
    plant.advance();
    for (const auto values : {plant.psi(), plant.psid(), plant.applied()}) see(values);
    seen.push_back(plant.work());
  }
  return seen;
}

class PlantStates : public testing::TestWithParam<Case> {};

TEST_P(PlantStates, PutBackGiveTheSameBytesAgain) {
  Plant plant = rig_plant(GetParam().settings, 0.5), other = rig_plant(GetParam().settings, 0.5);
  course(plant, 100);
  const PlantState kept = plant.state();
  const auto first = course(plant, 100);
  const PlantState end = plant.state();
  EXPECT_FALSE(end == kept);
  plant.put_back(kept);
  EXPECT_TRUE(plant.state() == kept);
  EXPECT_EQ(course(plant, 100), first);
  EXPECT_TRUE(plant.state() == end);
  other.put_back(kept);
  EXPECT_EQ(course(other, 100), first) << "in another plant that is built like it";
}

INSTANTIATE_TEST_SUITE_P(All, PlantStates, testing::ValuesIn(cases()),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(PlantStates, KnowThatTheMotorsAreLocked) {
  Plant plant = rig_plant({});
  course(plant, 10);
  const PlantState free = plant.state();
  plant.lock();
  const PlantState locked = plant.state();
  course(plant, 10);
  EXPECT_EQ(plant.psid()[0], 0);
  plant.put_back(free);
  course(plant, 10);
  EXPECT_NE(plant.psid()[0], 0);
  plant.put_back(locked);
  course(plant, 10);
  EXPECT_EQ(plant.psid()[0], 0);
}

// Late, doubled, missing commands up to the safe state, kept between them and put back.
TEST(PlantStates, OfDeadlinesPutBackGiveTheSameBytesAgain) {
  for (const char* how : {"hold", "brake"}) {
    const Experiment experiment = load_experiment(
        std::filesystem::path(MIXLOOP_EXPERIMENTS "/paper.yaml"),
        {{"plant.command_delay", "300 us"}, {"real_time.max_missed", "10"}, {"real_time.safe_state", how}});
    const Plan plan = make_plan(experiment);
    DeadlinePlant hardware = make_deadline_plant(experiment, plan);
    const auto live = [&](std::int64_t ticks) {
      std::vector<double> seen;
      for (std::int64_t i = 0; i < ticks; ++i) {
        const std::int64_t k = hardware.plant().tick();
        const double tau[] = {0.01 * static_cast<double>(k % 7), -0.1, 0.05};
        if (k % 50 < 45 && k < 150) hardware.command({.offset = 1000 * (k % 900), .command = k - k % 3}, tau);
        hardware.finish_tick();
        for (const auto values : {hardware.plant().psi(), hardware.plant().applied(), hardware.commanded()})
          seen.insert(seen.end(), values.begin(), values.end());
      }
      return seen;
    };
    live(100);
    const DeadlineState kept = hardware.state();
    const PlantState plant = hardware.plant().state();
    const auto first = live(100);
    const DeadlineState end = hardware.state();
    EXPECT_TRUE(hardware.safe());
    hardware.put_back(kept, plant);
    EXPECT_FALSE(hardware.safe());
    EXPECT_TRUE(hardware.state() == kept);
    EXPECT_EQ(live(100), first);
    EXPECT_TRUE(hardware.state() == end);
  }
}

}  // namespace
}  // namespace mixloop
