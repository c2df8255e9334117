// SPDX-License-Identifier: MIT
#include "processes/plant_line.hpp"

#include <fmt/format.h>

#include "loop/measured.hpp"
#include "processes/config_words.hpp"
#include "processes/speed.hpp"

namespace mixloop {

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
