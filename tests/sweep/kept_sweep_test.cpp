// SPDX-License-Identifier: MIT
// A sweep's folder tells of it without the experiment's files.
#include <gmock/gmock.h>

#include <fstream>

#include "sweep/folder.hpp"
#include "sweep/kept_sweep.hpp"
#include "tests/support/command.hpp"
#include "tests/sweep/refused_with.hpp"

namespace mixloop {
namespace {

SweepRequest of_all_kinds() {
  SweepRequest request;
  request.called = "mixloop sweep 'it''s.yaml'";
  request.experiment = MIXLOOP_EXPERIMENTS "/paper.yaml";
  request.overrides = {{"expect", "{}"}, {"limits.position_error", "300 mm"}};
  request.design.varied = {parse_varied("parameters.payload=0..5 kg:4"),
                           parse_varied("controller.kp=[100, 25, 25],[80, 25, 25]")};
  request.design.sampled = {parse_sampled("plant.command_delay=uniform(0.1 us, 300)"),
                            parse_sampled("controller.kv[0]=normal(1, 0.1)")};
  request.design.draws = 7;
  request.design.spread = Spread::sobol;
  request.design.seed = 0xfedcba9876543210;
  return request;
}

TEST(KeptSweep, HasEveryRunsValuesAndCommand) {
  const ScratchFolder scratch;
  const Sweep sweep("all kinds", of_all_kinds(), Evaluation::interpreter, false);
  const SweepFolder folder(scratch.path() / "kept", sweep, {});
  EXPECT_TRUE(is_sweep_folder(folder.path()));
  EXPECT_FALSE(is_sweep_folder(scratch.path()));
  const KeptSweep kept = read_kept_sweep(folder.path());
  EXPECT_EQ(kept.name, "all kinds");
  EXPECT_EQ(kept.called, sweep.setup().request().called);
  EXPECT_EQ(kept.sha256, sweep.sha256());
  EXPECT_EQ(kept.spread, "sobol");
  ASSERT_EQ(kept.design.runs(), 56);
  for (std::int64_t run = 0; run < 56; ++run) EXPECT_EQ(kept.command(run), sweep.command(run));
  ASSERT_EQ(kept.columns.size(), sweep.telling().columns.size());
  for (std::size_t i = 0; i < kept.columns.size(); ++i) {
    EXPECT_EQ(kept.columns[i].name, sweep.telling().columns[i].name);
    EXPECT_EQ(kept.columns[i].unit, sweep.telling().columns[i].unit);
  }
}

TEST(KeptSweep, RefusesWhatSomebodyChangedAtItsPlace) {
  const ScratchFolder folder;
  const auto read = [&] { read_kept_sweep(folder.path()); };
  expect_refused_with("no_such_file", "the same command in the same folder writes it", read);
  const auto with = [&](const std::string& design, const std::string& seed, const std::string& set) {
    folder.write("asked.yaml", "{sweep: a, called: b, experiment: c, set: " + set +
                                   ", vary: {x: '1, 2'}, sample: {}, draws: 3, design: " + design +
                                   ", seed: " + seed + ", columns: [], sha256: d}");
  };
  with("latin", "1", "[]");
  EXPECT_EQ(read_kept_sweep(folder.path()).design.runs(), 2);
  with("lattice", "1", "[]");
  expect_refused_with("unknown_value", "latin", read);
  with("latin", "-1", "[]");
  expect_refused_with("wrong_kind", "whole number", read);
  with("latin", "1", "[[a]]");
  expect_refused_with("wrong_size", "two texts", read);
  folder.write("asked.yaml", "{sweep: a, what: b}");
  expect_refused_with("unknown_key", "'what'", read);
}

}  // namespace
}  // namespace mixloop
