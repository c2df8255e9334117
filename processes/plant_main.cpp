// SPDX-License-Identifier: MIT
// mixloop-plant: the simulated hardware, on the bus. It owns the clock and keeps the result.
#include <fmt/format.h>

#include <csignal>

#include "notation/long_work.hpp"
#include "processes/keep.hpp"
#include "processes/plant_session.hpp"
#include "runtime/protocol/session.hpp"

namespace mixloop {
namespace {

/// One session after the other, as the operator resets it. The exit status.
int run(const PlantLine& line) {
  StopSwitch stop;
  stop.turn_on_signals();
  const WorkWatch watch([&] { return stop.turned(); });
  Experiment loaded = line.load();
  loaded.plant.faults.injected = line.allow_faults;
  const Plan plan = make_plan(loaded);
  const Experiment experiment = with_integrator_settled(loaded, plan);
  ReportLine report(line.report_fd);
  // Of `mixloop run` it has been done, and its log lies there.
  if (!line.out.empty() && line.report_fd < 0) begin_run_folder(line.out);
  Bus bus(line.bus);
  if (line.report_fd < 0)
    line.say_waiting("mixloop-plant", experiment.has_path() ? "a controller and a planner" : "a controller",
                     "COMMAND");
  for (std::int64_t session = line.session;;) {
    PlantSession plant(line, experiment, plan, report);
    const std::int64_t next = draw_session();
    if (plant.run(bus, stop, session, next) != Ending::reset) return plant.exit_status();
    if (line.report_fd < 0) fmt::print(stderr, "mixloop-plant: reset, to tick 0 of a new session\n");
    session = next;
  }
}

}  // namespace
}  // namespace mixloop

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);
  return mixloop::plant_main(argc, argv, mixloop::run);
}
