// SPDX-License-Identifier: MIT
#include "processes/plant_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "loop/measured.hpp"
#include "processes/config_words.hpp"
#include "processes/speed.hpp"

namespace mixloop {

int plant_main(int argc, char** argv, int (*run)(const PlantLine&)) {
  int status = 0;
  PlantLine line;
  CLI::App app(
      "mixloop-plant: the simulated hardware of an experiment, on the LCM bus. It owns the clock: tick k is "
      "plant time k / rate.");
  add_peer_options(app, line);
  app.add_option("--speed", line.speed,
                 "plant seconds a real second; max, as fast as it goes, is lockstep's default, 1 real time's")
      ->type_name("X");
  app.add_flag("--paused", line.paused, "begin paused, at tick 0; see mixloop control");
  app.add_flag("--hold", line.hold, "go on past the end until stopped, a path's end point held");
  app.add_flag("--truth", line.truth, "publish TRUTH, which no controller may read");
  app.add_flag("--allow-faults", line.allow_faults, "obey FAULT messages: mixloop control fault");
  app.add_option("--out", line.out, "keep result.json and trajectory.csv in this folder")->type_name("DIR");
  app.add_option("--report-fd", line.report_fd, "tell `mixloop run` over this file descriptor")->group("");
  app.footer(
      "Publishes STATE, waits for COMMAND; start mixloop-controller and, unless there is no path,\n"
      "mixloop-planner on the same experiment, in any order.\n"
      "With --realtime it waits for tick 0's COMMAND only: from then on commands have a deadline.\n"
      "Exit status: 0 held, 1 a bound missed, 2 bad input, 3 a fault at run time, 130 interrupted.");
  app.callback([&] { status = run(line); });
  return run_command_line(argc, argv, app, status);
}

PlantOptions plant_options(const PlantLine& line, const Experiment& experiment, std::int64_t last_tick,
                           std::int64_t session) {
  const std::string& speed = line.speed;
  const auto measured = static_cast<int>(measured_coordinates(experiment).size());
  return {.n = measured,
          .unmeasured = experiment.scene->n() - measured,
          .n_u = experiment.scene->n_u(),
          .last_tick = last_tick,
          .references = experiment.has_path(),
          .rate_hz = experiment.rate_hz,
          .speed = speed_of(!speed.empty()   ? speed
                            : line.real_time ? "1"
                                             : "max"),
          .session = session,
          .config = config_of(common_ground(experiment)),
          .config_words = config_words(experiment),
          .truth = line.truth,
          .hold = line.hold,
          .paused = line.paused,
          .max_missed = experiment.deadline.max_missed,
          .first_wait = line.first_wait_ns(),
          .patience = line.patience_ns(),
          .notice = [is_told = line.report_fd < 0](const std::string& text) {
            if (is_told) fmt::print(stderr, "mixloop-plant: {}\n", text);
          }};
}

}  // namespace mixloop
