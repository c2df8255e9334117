// SPDX-License-Identifier: MIT
#include "runtime/protocol/lockstep_plant.hpp"

namespace mixloop {

Ending LockstepPlant::run_ticks() {
  using Answer = PlantPort::Answer;
  PlantReport& report = port_.report;
  Instant start{0};

  for (std::int64_t k = 0; before_end(k); ++k) {
    if (k > 0)
      if (const Answer a = port_.wait_for_due(k); a != Answer::due) return ending_at(k, a);
    if (!port_.publish_state(k)) return Ending::broken_off;
    if (k > 0) port_.publish_truth(k - 1);
    port_.publish_timing({});
    if (const Answer a = port_.wait_for_command(); a != Answer::command) return ending_at(k, a);
    port_.want_from(k + 1);

    const Instant arrived = now();
    if (k == 0) {
      start = arrived;
      port_.start(arrived);
    } else {
      report.round_trip.add(arrived - port_.sent());
    }
    if (k <= options_.last_tick) report.wall_time = arrived - start;
    const bool sound = plant_.advance(k, port_.command().tau_commanded);
    report.ticks_done = k + 1;
    if (!sound) return Ending::broken_off;
  }
  port_.publish_truth(options_.last_tick);
  return Ending::finished;
}

}  // namespace mixloop
