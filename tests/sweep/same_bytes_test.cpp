// SPDX-License-Identifier: MIT
// A run of a sweep is, to the bit, what simulate makes of the experiment that is written with its values; and
// a table has the same bytes however its runs are split.
#include <gmock/gmock.h>

#include "sweep/go_through.hpp"
#include "sweep/table.hpp"
#include "sweep/written_run.hpp"
#include "tests/support/command.hpp"
#include "tests/support/simulated.hpp"
#include "tests/sweep/refused_with.hpp"

extern "C" void mixloop_write_hdf5(const std::filesystem::path& file,
                                   const std::vector<mixloop::FileColumn>& columns, std::int64_t rows,
                                   const mixloop::EachRow& each);

namespace mixloop {
namespace {

/// A tenth of a second of the paper's line.
SweepRequest short_line() {
  SweepRequest request;
  request.experiment = MIXLOOP_EXPERIMENTS "/paper.yaml";
  request.overrides = {{"path", "{line: {from: [0.3, 0.0, 0.8], to: [0.29, 0.01, 0.79]}, duration: 0.1 s}"}};
  request.design.sampled = {parse_sampled("parameters.payload=normal(5 kg, 1 kg)")};
  return request;
}

Sweep sweep_of(const SweepRequest& request, bool hashes = true) {
  return Sweep("test", request, Evaluation::interpreter, hashes);
}

void expect_written_runs_are_the_same(const SweepRequest& request, const std::vector<std::int64_t>& runs) {
  const ScratchFolder folder;
  const Sweep sweep = sweep_of(request);
  for (const std::int64_t run : runs) {
    SCOPED_TRACE(sweep.command(run));
    const auto outcomes =
        run_batch(sweep.setup(), sweep.telling(), run_one_by_one, run, 1, [] { return true; });
    ASSERT_EQ(outcomes.size(), 1U);
    const auto file = folder.path() / "written.yaml";
    write_run(file, sweep.setup(), run);
    Experiment written = load_experiment(file, {});
    written.evaluation = Evaluation::interpreter;
    const Measures measures = simulated(written);
    EXPECT_EQ(outcomes[0].sha256, measures.trajectory_sha256);
    EXPECT_EQ(outcomes[0].values[0], measures.max_position_error);
    Experiment set = load_experiment(request.experiment, [&] {
      auto all = request.overrides;
      for (auto& one : sweep.setup().design().overrides(run)) all.push_back(one);
      return all;
    }());
    set.evaluation = Evaluation::interpreter;
    EXPECT_EQ(outcomes[0].sha256, simulated(set).trajectory_sha256);
  }
}

TEST(SweptRun, IsToTheBitThatOfTheExperimentWrittenWithItsValues) {
  SweepRequest request = short_line();
  request.design.sampled.push_back(parse_sampled("plant.command_delay=uniform(0, 600 us)"));
  request.design.sampled.push_back(parse_sampled("controller.kp[1]=uniform(20 N m/rad, 30)"));
  request.design.sampled.push_back(parse_sampled("plant.sensors.noise=uniform(0, 0.01 deg)"));
  request.design.draws = 1000;
  expect_written_runs_are_the_same(request, {0, 17, 500, 999});
}

TEST(SweptRun, AlsoWhereTheSceneThePathOrTheIntegratorIsVaried) {
  SweepRequest request = short_line();
  request.design.sampled = {};
  request.design.varied = {parse_varied("scene.constants.L1=30 cm,31 cm"),
                           parse_varied("path.line.to[0]=0.29,0.288"),
                           parse_varied("plant.integrator=rk4,auto"), parse_varied("rate=1000 Hz,2000 Hz")};
  expect_written_runs_are_the_same(request, {0, 6, 9, 15});
}

TEST(SweptRun, AlsoOfClosuresThatSwitchTheirCoordinates) {
  SweepRequest request;
  request.experiment = MIXLOOP_EXPERIMENTS "/four_bar_rocker_turns.yaml";
  request.overrides = {{"duration", "0.2 s"}, {"expect", "{}"}};
  request.design.varied = {parse_varied("plant.substeps=1,2")};
  const Sweep sweep = sweep_of(request);
  const auto outcomes = run_batch(sweep.setup(), sweep.telling(), run_one_by_one, 0, 2, [] { return true; });
  Experiment set =
      load_experiment(request.experiment, {{"duration", "0.2 s"}, {"expect", "{}"}, {"plant.substeps", "2"}});
  set.evaluation = Evaluation::interpreter;
  EXPECT_EQ(outcomes[1].sha256, simulated(set).trajectory_sha256);
}

class SplitSweep : public testing::Test {
 protected:
  /// The table, its runs gone through by the parts in this order.
  std::string table(const std::vector<Part>& parts, int threads, const std::function<bool()>& goes_on) const {
    const ScratchFolder folder;
    for (const Part& part : parts) {
      const SweepFolder kept(folder.path(), sweep, part);
      go_through(sweep, kept, part, {.threads = threads, .goes_on = goes_on});
    }
    const SweepFolder all(folder.path(), sweep, {});
    go_through(sweep, all, {}, {.threads = threads});
    const KeptRuns runs(all.journals(), sweep.sha256(), sweep.telling().columns.size());
    const EachRun each = [&](const auto& told) { runs.each(told); };
    write_csv(folder.path() / "table.csv", sweep, each);
    std::string bytes = bytes_of(folder.file("table.csv"));
#if MIXLOOP_HAS_HDF5
    write_columns(folder.path() / "table.h5", sweep, each, mixloop_write_hdf5);
    bytes += bytes_of(folder.file("table.h5"));
#endif
    return bytes;
  }

  SweepRequest request = [] {
    SweepRequest some = short_line();
    some.overrides[0].value = "{line: {from: [0.3, 0.0, 0.8], to: [0.299, 0.001, 0.799]}, duration: 0.01 s}";
    some.design.draws = 300;
    some.settled_within = 1e-6;
    return some;
  }();
  const Sweep sweep = sweep_of(request, false);
};

// The others would wait for the runs that the one that fails has in hand.
TEST_F(SplitSweep, EndsWhereAnEngineFails) {
  const ScratchFolder folder;
  const SweepFolder kept(folder.path(), sweep, {});
  std::atomic<int> calls{0};
  const auto failing = [&](std::span<const PreparedRun> runs, const Telling& telling) {
    if (++calls == 20) throw RunFault("no_device", "it is gone");
    return run_one_by_one(runs, telling);
  };
  EXPECT_THROW(go_through(sweep, kept, {}, {.engine = failing, .threads = 4}), RunFault);
  const KeptRuns runs(kept.journals(), sweep.sha256(), sweep.telling().columns.size());
  EXPECT_FALSE(runs.done().empty()) << "what was brought before is kept";
}

TEST_F(SplitSweep, HasTheSameBytes) {
  const auto on = [] { return true; };
  const std::string whole = table({{}}, 1, on);
  EXPECT_EQ(std::ranges::count(whole.substr(0, whole.find("\x89HDF")), '\n'), 301);
  // Told apart by a bool: a failure needn't print them.
  EXPECT_TRUE(table({{}}, 2, on) == whole);
  EXPECT_TRUE(table({{2, 3}, {0, 3}, {1, 3}}, 2, on) == whole);
  std::atomic<int> asked = 0;
  EXPECT_TRUE(table({{}, {}, {}}, 2, [&] { return ++asked % 20 != 0; }) == whole) << "interrupted";
}

TEST_F(SplitSweep, TwoInOneFolderAreRefused) {
  const ScratchFolder folder;
  const SweepFolder first(folder.path(), sweep, {});
  expect_refused_with("in_use", "process " + std::to_string(getpid()),
                      [&] { SweepFolder(folder.path(), sweep, {}); });
  expect_refused_with("in_use", "is at work on this sweep", [&] {
    SweepFolder(folder.path(), sweep, {0, 2});
  });
}

TEST_F(SplitSweep, AFolderOfOtherSettingsIsRefusedWithWhatDiffers) {
  const ScratchFolder folder;
  { const SweepFolder first(folder.path(), sweep, {}); }
  request.design.seed = 2;
  expect_refused_with("another_sweep", "seed: '1', and now '2' is asked for",
                      [&] { SweepFolder(folder.path(), sweep_of(request, false), {}); });
  request.design.seed = 1;
  request.overrides.push_back({"controller.kp[0]", "99"});
  expect_refused_with("another_sweep", "experiment_sha256",
                      [&] { SweepFolder(folder.path(), sweep_of(request, false), {}); });
}

}  // namespace
}  // namespace mixloop
