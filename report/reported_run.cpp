// SPDX-License-Identifier: MIT
#include "report/reported_run.hpp"

namespace mixloop {

ReportedRun read_run(const std::filesystem::path& path, const ReadOptions& options, std::size_t capacity) {
  RunFile file = open_run(path, options);
  const auto axes = file.scene ? file.scene->end_effector.axes : std::vector<int>{0, 1, 2};
  ReportedRun run{file, Curves(axes, file.rate_hz, capacity), {}};
  run.facts = read_ticks(run, [&](const Tick& tick) { run.curves.add(tick); });
  return run;
}

}  // namespace mixloop
