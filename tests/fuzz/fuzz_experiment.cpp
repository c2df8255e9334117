// SPDX-License-Identifier: MIT
// An experiment file in the experiments' folder; where it loads and is short, or far too long, its path is
// planned and checked too.
#include "loop/experiment.hpp"
#include "tests/fuzz/check.hpp"

namespace {

using namespace mixloop;

double ticks_of(const Experiment& experiment) {
  double seconds = experiment.path.approach.value_or(0.0);
  for (const auto& via : experiment.path.vias)
    seconds += (via.duration + via.dwell) * (1.0 + experiment.path.repeat);
  const int rows = stage_rows(experiment.plant.integrator).rows * experiment.plant.substeps;
  return seconds * experiment.rate_hz * (experiment.plant.continuous ? rows : 1);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  refuses_or_reads("", [&] {
    const std::filesystem::path file = MIXLOOP_EXPERIMENTS "/fuzz.yaml";
    const Experiment experiment =
        load_experiment(parse_document(text_of(data, size), file.string()), file, {});
    common_ground(experiment);
    const double ticks = ticks_of(experiment);
    if (ticks < 100 || ticks > 1e9) make_plan(experiment);
  });
  return 0;
}
