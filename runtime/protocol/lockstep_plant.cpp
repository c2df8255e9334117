// SPDX-License-Identifier: MIT
#include "runtime/protocol/lockstep_plant.hpp"

#include <stdexcept>

namespace mixloop {

LockstepPlant::LockstepPlant(Bus& bus, const StopSwitch& stop, const PlantOptions& options, PlantSide plant)
    : plant_(std::move(plant)),
      last_tick_(options.last_tick),
      hold_(options.hold),
      port_(bus, stop, options, plant_, 0, std::chrono::milliseconds(10)) {
  if (!plant_.advance) throw std::logic_error("a function of the plant's side is missing");
}

Ending LockstepPlant::run() {
  try {
    const Ending ending = run_ticks();
    if (ending != Ending::reset) port_.send_end(ending);
    return ending;
  } catch (...) {
    port_.send_end(Ending::broken_off);
    throw;
  }
}

Ending LockstepPlant::run_ticks() {
  using Answer = PlantPort::Answer;
  PlantReport& report = port_.report;
  Instant start{0};
  const auto early_ending = [&](std::int64_t tick, Answer answer) {
    const bool held_on = tick > last_tick_ && answer != Answer::reset;
    return held_on ? Ending::finished : ending_of(answer);
  };

  for (std::int64_t k = 0; before_end(k); ++k) {
    if (k > 0)
      if (const Answer a = port_.wait_for_due(k); a != Answer::due) return early_ending(k, a);
    if (!port_.publish_state(k)) return Ending::broken_off;
    if (k > 0) port_.publish_truth(k - 1);
    port_.publish_timing({});
    if (const Answer a = port_.wait_for_command(); a != Answer::command) return early_ending(k, a);
    port_.want_from(k + 1);

    const Instant arrived = now();
    if (k == 0) {
      start = arrived;
      port_.start(arrived);
    } else {
      report.round_trip.add(arrived - port_.sent());
    }
    if (k <= last_tick_) report.wall_time = arrived - start;
    const bool sound = plant_.advance(k, port_.command().tau_commanded);
    report.ticks_done = k + 1;
    if (!sound) return Ending::broken_off;
  }
  port_.publish_truth(last_tick_);
  return Ending::finished;
}

}  // namespace mixloop
