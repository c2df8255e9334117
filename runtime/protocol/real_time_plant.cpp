// SPDX-License-Identifier: MIT
#include "runtime/protocol/real_time_plant.hpp"

#include <algorithm>
#include <cmath>

#include "notation/errors.hpp"
#include "runtime/protocol/conductor.hpp"

namespace mixloop {
namespace {

nanoseconds quarter_tick(const PlantOptions& options) {
  require_real_time_speed(options.speed);
  return nanoseconds(std::llround(0.25e9 / (options.rate_hz * options.speed)));
}

}  // namespace

void require_real_time_speed(double speed) {
  if (const char* reason = objection_to_speed(speed, true))
    throw InputError("out_of_range", {"--speed"}, reason);
}

RealTimePlant::RealTimePlant(Bus& bus, const StopSwitch& stop, const PlantOptions& options,
                             RealTimeSide& plant)
    : PlantRunner(bus, stop, options, plant, state_t::FLAG_REAL_TIME, quarter_tick(options)), plant_(plant) {}

Ending RealTimePlant::run_ticks() {
  using Answer = PlantPort::Answer;
  if (!port_.publish_state(0)) return Ending::broken_off;
  if (const Answer a = port_.wait_for_command(); a != Answer::command) return ending_at(0, a);
  const Instant start = now();
  port_.start(start);
  take_command(0);

  for (std::int64_t k = 0; before_end(k); ++k) {
    if (const Answer a = live_through(k); a != Answer::due) return ending_at(k, a);
    if (k <= options_.last_tick) port_.report.wall_time = now() - start;
    if (port_.report.ticks_done <= k) return Ending::broken_off;
    if (!before_end(k + 1)) break;
    judge_pace(k + 1);
    if (!port_.publish_state(k + 1, plant_.is_safe() ? state_t::FLAG_SAFE_STATE : 0))
      return Ending::broken_off;
  }
  return Ending::finished;
}

// Until tick + 1 is due. No command can be newer than the tick's own: with it the plant goes on at once, and
// what is left of the tick is free for what can wait.
PlantPort::Answer RealTimePlant::live_through(std::int64_t tick) {
  using Answer = PlantPort::Answer;
  const auto finish = [&] {
    if (plant_.finish_tick(tick)) port_.report.ticks_done = tick + 1;
  };
  port_.want_from(std::max(newest_ + 1, tick - options_.max_missed));
  while (newest_ < tick) {
    const Answer a = port_.wait_until(port_.pacer().due(tick + 1));
    if (a == Answer::due) break;
    if (a != Answer::command) return a;
    take_command(tick);
    port_.want_from(newest_ + 1);
  }
  finish();
  if (port_.report.ticks_done <= tick) return Answer::due;
  if (newest_ == tick) {
    port_.publish_truth(tick, plant_.is_safe() ? truth_t::FLAG_SAFE_STATE : 0);
    port_.publish_timing(plant_.deadlines());
  }
  return port_.wait_for_due(tick + 1);
}

void RealTimePlant::take_command(std::int64_t tick) {
  const command_t& command = port_.command();
  const Instant at = now();
  newest_ = command.seq;
  // Handled after the tick's end, the plant having overslept: then it came at that end at the latest.
  const nanoseconds begin = port_.pacer().due(tick), last = port_.pacer().due(tick + 1) - nanoseconds(1);
  const auto after = static_cast<double>((std::min(at, last) - begin).count());
  plant_.command(command, std::llround(after * port_.pacer().speed()));
  if (tick > 0 && command.seq == tick) port_.report.round_trip.add(at - port_.sent());
  safe_commands_ = (command.flags & command_t::FLAG_SAFE) != 0 ? safe_commands_ + 1 : 0;
  if (safe_commands_ > options_.max_missed) plant_.make_safe("the controller sends safe commands");
}

// `tick` has begun.
void RealTimePlant::judge_pace(std::int64_t tick) {
  const auto tick_length = port_.pacer().due(tick) - port_.pacer().due(tick - 1);
  if (port_.last_late() > options_.max_missed * tick_length)
    plant_.make_safe("the plant itself was suspended");
}

}  // namespace mixloop
