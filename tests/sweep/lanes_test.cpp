// SPDX-License-Identifier: MIT
// Runs side by side in lanes are, to the bit, those that go one after the other.
#include <gmock/gmock.h>

#include "sweep/go_through.hpp"
#include "sweep/kernel/closed_loops.hpp"
#include "sweep/kernel/kernel_source.hpp"
#include "tests/support/command.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

/// A tenth of a second of the paper's line, by this law.
SweepRequest short_paper(const std::string& law) {
  SweepRequest request;
  request.experiment = MIXLOOP_EXPERIMENTS "/paper.yaml";
  request.overrides = {{"path", "{line: {from: [0.3, 0.0, 0.8], to: [0.25, 0.05, 0.75]}, duration: 0.1 s}"},
                       {"controller.law", law}};
  return request;
}

/// `runs` of a sweep by both engines, whose outcomes, hashes among them, must be equal; those of the lanes.
std::vector<Outcome> expect_equal(const SweepRequest& request, std::int64_t runs) {
  Sweep sweep("test", request, Evaluation::interpreter, true);
  Telling telling = sweep.telling();
  telling.settled_within = 1e-3;
  const auto goes_on = [] { return true; };
  const auto alone = run_batch(sweep.setup(), telling, run_one_by_one, 0, runs, goes_on);
  auto beside = run_batch(sweep.setup(), telling, LaneEngine(), 0, runs, goes_on);
  EXPECT_EQ(alone.size(), static_cast<std::size_t>(runs));
  EXPECT_EQ(beside.size(), alone.size());
  for (std::size_t i = 0; i < std::min(alone.size(), beside.size()); ++i) {
    EXPECT_EQ(beside[i].run, alone[i].run) << i;
    EXPECT_EQ(beside[i].end, alone[i].end) << i;
    EXPECT_EQ(beside[i].sha256, alone[i].sha256) << i;
    EXPECT_FALSE(alone[i].sha256.empty()) << i;
    for (std::size_t j = 0; j < alone[i].values.size(); ++j)
      EXPECT_TRUE(beside[i].values[j] == alone[i].values[j] ||
                  (std::isnan(beside[i].values[j]) && std::isnan(alone[i].values[j])))
          << i << " " << telling.columns[j].name << " " << beside[i].values[j] << " " << alone[i].values[j];
  }
  return beside;
}

PreparedRun prepared(const SweepRequest& request) {
  const Sweep sweep("test", request, Evaluation::interpreter, false);
  return sweep.setup().prepared(0);
}

class EveryLaw : public testing::TestWithParam<const char*> {};

// Eleven runs: a whole set of lanes and part of another.
TEST_P(EveryLaw, HasTheBitsOfRunsOneByOne) {
  SweepRequest request = short_paper(GetParam());
  request.design.sampled = {parse_sampled("plant.parameters.payload=uniform(0 kg, 9 kg)"),
                            parse_sampled("controller.kp[1]=uniform(20 N m/rad, 30)")};
  ASSERT_EQ(hindrance_in_lanes(prepared(request)), "");
  expect_equal(request, 11);
}
INSTANTIATE_TEST_SUITE_P(Lanes, EveryLaw,
                         testing::Values("pd", "pd_gravity", "pd_feedforward", "computed_torque"));

TEST(Lanes, HaveDelaysOfTheirOwn) {
  SweepRequest request = short_paper("pd_feedforward");
  request.design.varied = {parse_varied("plant.command_delay=0 us,300 us,1 ms,1.4 ms,2 ms,2.7 ms")};
  expect_equal(request, 6);
}

/// Drives and sensors that aren't ideal, and what of them each run has of its own.
struct NotIdeal {
  const char* name;
  const char* entry;
  const char* value;
  std::vector<const char*> varied;
};

class EveryHardware : public testing::TestWithParam<NotIdeal> {};

TEST_P(EveryHardware, HasTheBitsOfRunsOneByOne) {
  SweepRequest request = short_paper("pd_feedforward");
  request.overrides.push_back({GetParam().entry, GetParam().value});
  request.overrides.push_back({"plant.torque_limit", "[20, 20, 20]"});
  for (const char* varied : GetParam().varied) request.design.varied.push_back(parse_varied(varied));
  ASSERT_EQ(hindrance_in_lanes(prepared(request)), "");
  const auto outcomes = expect_equal(request, 9);
  EXPECT_NE(outcomes[0].sha256, outcomes[1].sha256);
  EXPECT_NE(outcomes[0].sha256, outcomes[3].sha256);
}
INSTANTIATE_TEST_SUITE_P(
    Lanes, EveryHardware,
    testing::Values(
        NotIdeal{
            "Lag",
            "plant.actuators",
            "{time_constant: [0.5 ms, 0 s, 2 ms]}",
            {"plant.actuators.time_constant[1]=0 s,0.3 ms,1 ms", "plant.command_delay=0 us,300 us,1.4 ms"}},
        NotIdeal{"RateLimit",
                 "plant.actuators",
                 "{rate_limit: [500, 200 N m/s, 20]}",
                 {"plant.actuators.rate_limit[0]=30,100,1000", "plant.command_delay=300 us,0 us,1.4 ms"}},
        NotIdeal{"RateLimitAndLag",
                 "plant.actuators",
                 "{rate_limit: [50, 20, 20], time_constant: [0.5 ms, 0 s, 1 ms]}",
                 {"plant.actuators.rate_limit[1]=10,100,1000",
                  "plant.actuators.time_constant[0]=0 s,0.3 ms,1 ms"}},
        NotIdeal{
            "RippleAndFriction",
            "plant.actuators",
            "{ripple: {amplitude: [0.03, 0, 0.05], per_turn: [12, 12, 7]}, friction: {viscous: [0.01, 0, "
            "0.02], coulomb: [0.05, 0.1, 0]}}",
            {"plant.actuators.ripple.amplitude[1]=0,0.02,0.1",
             "plant.actuators.friction.coulomb[2]=0,0.01,0.02"}},
        NotIdeal{"Noise",
                 "plant.sensors",
                 "{resolution: 1 rev / 16384, noise: [0.005 deg, 0 deg, 0.01 deg], bias: [0.1 deg, 0 deg, "
                 "-0.05 deg]}",
                 {"seed=1,2,3", "plant.sensors.noise[1]=0 deg,0.01 deg,0.002 deg"}},
        NotIdeal{
            "Differences",
            "plant.sensors",
            "{resolution: 1 rev / 65536, velocity: differentiated, velocity_filter: 200 Hz}",
            {"plant.sensors.velocity_filter=50 Hz,100 Hz,200 Hz", "plant.command_delay=0 us,300 us,1 ms"}},
        NotIdeal{"Delay",
                 "plant.sensors",
                 "{delay: [1 ms, 0 ms, 2 ms], noise: 0.001 deg}",
                 {"plant.sensors.delay[0]=0 ms,1 ms,3 ms", "plant.sensors.delay[1]=0 ms,1 ms,2 ms"}}),
    [](const auto& tested) { return tested.param.name; });

TEST(Lanes, HaveSensorsBesideDrives) {
  SweepRequest request = short_paper("computed_torque");
  request.overrides.push_back(
      {"plant.sensors", "{resolution: 1 rev / 16384, noise: 0.005 deg, velocity: differentiated}"});
  request.overrides.push_back({"plant.actuators", "{time_constant: 0.2 ms, friction: {viscous: 0.01}}"});
  request.design.varied = {parse_varied("seed=1,2,3"), parse_varied("plant.substeps=1,2")};
  expect_equal(request, 6);
}

TEST(Lanes, HaveStepsLimitsAndReferencesOfTheirOwnKind) {
  SweepRequest request = short_paper("computed_torque");
  request.overrides.push_back({"controller.feedforward_at", "desired"});
  request.overrides.push_back({"plant.substeps", "3"});
  request.overrides.push_back({"plant.torque_limit", "[1.5, 3, 2]"});
  request.design.varied = {parse_varied("controller.kv[0]=0.5,1,2")};
  expect_equal(request, 3);
}

// Gains of the wrong sign throw it off the path at another time in each lane; the others go on.
TEST(Lanes, GoOnWhereOneOfThemDiverges) {
  SweepRequest request = short_paper("pd");
  request.design.varied = {parse_varied("controller.kp[1]=25,-4000,25,-100000,-1e9,30")};
  const auto outcomes = expect_equal(request, 6);
  EXPECT_EQ(outcomes[0].end, outcomes[2].end);
  EXPECT_EQ(outcomes[3].end, RunEnd::diverged);
  EXPECT_NE(outcomes[3].sha256, outcomes[4].sha256);
}

// Of two plans by turns only neighbours of one lie side by side.
TEST(Lanes, TellPlansApart) {
  SweepRequest request = short_paper("pd_feedforward");
  request.design.varied = {parse_varied("path.line.to[0]=0.25,0.26"),
                           parse_varied("controller.kp[0]=90,100,110")};
  expect_equal(request, 6);
}

TEST(Lanes, SayWhatTheyDontHave) {
  const auto why = [](const std::string& key, const std::string& value) {
    SweepRequest request = short_paper("pd_feedforward");
    request.overrides.push_back({key, value});
    request.design.varied = {parse_varied("controller.kp[0]=90,100")};
    return hindrance_in_lanes(prepared(request));
  };
  EXPECT_THAT(why("plant.integrator", "gauss8"), HasSubstr("rk4"));
  EXPECT_THAT(why("plant.sensors", "{drop: 0.01}"), HasSubstr("drop readings"));
  EXPECT_THAT(why("faults", "[{kind: stuck, motor: 1, at: 0.05 s}]"), HasSubstr("fails"));
  EXPECT_THAT(why("plant.control", "continuous"), HasSubstr("continuous"));
  EXPECT_THAT(why("controller.safety", "{torque_limit: [20, 20, 20]}"), HasSubstr("limits"));
}

// What is emitted for a graphics processor, by the compilers at hand: its bits are the simulation's.
class CudaText : public testing::TestWithParam<const char*> {};

TEST_P(CudaText, HasTheBitsOfARun) {
  const std::string compiler = GetParam();
  if (std::system((compiler.substr(0, compiler.find(' ')) + " --version > /dev/null 2>&1").c_str()) != 0)
    GTEST_SKIP() << "no " << compiler;
  SweepRequest request = short_paper("computed_torque");
  request.design.varied = {parse_varied("plant.parameters.payload=4 kg,5 kg,6 kg")};
  const Sweep sweep("test", request, Evaluation::interpreter, true);
  std::vector<PreparedRun> runs;
  for (std::int64_t run = 0; run < 3; ++run) runs.push_back(sweep.setup().prepared(run));
  const ScratchFolder folder;
  const Experiment& experiment = runs[0].experiment;
  const std::string file = folder.write(
      "loop.cu",
      kernel_source({experiment.scene, experiment.controller_scene, true, true}, KernelTarget::cuda));
  const std::string library = folder.file("loop.so");
  ASSERT_EQ(std::system((compiler + " " + file + " -o " + library).c_str()), 0);
  const auto alone = run_one_by_one(runs, sweep.telling());
  const auto by_library = run_in_library(library, runs, sweep.telling());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(by_library[i].sha256, alone[i].sha256);
}
INSTANTIATE_TEST_SUITE_P(
    Lanes, CudaText,
    testing::Values("g++ -x c++ -std=c++17 -O1 -ffp-contract=off -shared -fPIC",
                    "nvcc -fmad=false -O1 -shared -Xcompiler -fPIC,-ffp-contract=off -diag-suppress 39,221"),
    [](const auto& tested) {
      return std::string(tested.param).starts_with("g++") ? "ByTheHosts" : "ByCudas";
    });

}  // namespace
}  // namespace mixloop
