// SPDX-License-Identifier: MIT
// mixloop-plant: the simulated hardware, on the bus. It owns the clock and keeps the result.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
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
  int status = 0;
  mixloop::PlantLine options;
  CLI::App app(
      "mixloop-plant: the simulated hardware of an experiment, on the LCM bus. It owns the clock: tick k is "
      "plant time k / rate.");
  mixloop::add_peer_options(app, options);
  app.add_option("--speed", options.speed,
                 "plant seconds a real second; max, as fast as it goes, is lockstep's default, 1 real time's")
      ->type_name("X");
  app.add_flag("--paused", options.paused, "begin paused, at tick 0; see mixloop control");
  app.add_flag("--hold", options.hold, "go on past the end until stopped, a path's end point held");
  app.add_flag("--truth", options.truth, "publish TRUTH, which no controller may read");
  app.add_flag("--allow-faults", options.allow_faults, "obey FAULT messages: mixloop control fault");
  app.add_option("--out", options.out, "keep result.json and trajectory.csv in this folder")
      ->type_name("DIR");
  app.add_option("--report-fd", options.report_fd, "tell `mixloop run` over this file descriptor")->group("");
  app.footer(
      "Publishes STATE, waits for COMMAND; start mixloop-controller and, unless there is no path,\n"
      "mixloop-planner on the same experiment, in any order.\n"
      "With --realtime it waits for tick 0's COMMAND only: from then on commands have a deadline.\n"
      "Exit status: 0 held, 1 a bound missed, 2 bad input, 3 a fault at run time, 130 interrupted.");
  app.callback([&] { status = mixloop::run(options); });
  return mixloop::run_command_line(argc, argv, app, status);
}
