// SPDX-License-Identifier: MIT
// mixloop-plant: the simulated hardware, on the bus. It owns the clock and keeps the result.
#include <CLI/CLI.hpp>
#include <csignal>

#include "processes/plant_process.hpp"

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
  app.add_flag("--hold", options.hold, "go on holding the end point until stopped");
  app.add_flag("--truth", options.truth, "publish TRUTH, which no controller may read");
  app.add_flag("--allow-faults", options.allow_faults, "obey FAULT messages: mixloop control fault");
  app.add_option("--out", options.out, "keep result.json and trajectory.csv in this folder")
      ->type_name("DIR");
  app.add_option("--report-fd", options.report_fd, "tell `mixloop run` over this file descriptor")->group("");
  app.footer(
      "Publishes STATE, waits for COMMAND; start mixloop-controller and mixloop-planner on the same "
      "experiment, in any order.\n"
      "With --realtime it waits for tick 0's COMMAND only: from then on commands have a deadline.\n"
      "Exit status: 0 held, 1 a bound missed, 2 bad input, 3 a fault at run time, 130 interrupted.");
  app.callback([&] { status = mixloop::run_plant_process(options); });
  return mixloop::run_command_line(argc, argv, app, status);
}
