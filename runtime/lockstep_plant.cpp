// SPDX-License-Identifier: MIT
#include "runtime/lockstep_plant.hpp"

#include <algorithm>
#include <stdexcept>

#include "notation/errors.hpp"
#include "runtime/config_hash.hpp"
#include "runtime/plant_time.hpp"
#include "runtime/session.hpp"

namespace mixloop {
namespace {

// Long enough to be sent five times more when datagrams get lost, short enough not to be noticed.
constexpr int kEndRepeats = 6;
constexpr auto kEndInterval = std::chrono::milliseconds(1);

std::int8_t end_reason(Ending ending) {
  switch (ending) {
    case Ending::finished:
      return sim_control_t::REASON_FINISHED;
    case Ending::interrupted:
      return sim_control_t::REASON_INTERRUPTED;
    case Ending::stopped:
      return sim_control_t::REASON_STOPPED;
    case Ending::broken_off:
      break;
  }
  return sim_control_t::REASON_FAULT;
}

}  // namespace

LockstepPlant::LockstepPlant(Bus& bus, const StopSwitch& stop, const LockstepOptions& options,
                             PlantSide plant)
    : bus_(bus),
      stop_(stop),
      options_(options),
      plant_(std::move(plant)),
      pacer_(options.rate_hz, options.speed),
      state_(options.n),
      truth_(options.n),
      control_(options.n),
      inbox_(options.n),
      state_channel_(bus.channel("STATE")),
      truth_channel_(bus.channel("TRUTH")),
      control_channel_(bus.channel("SIM_CONTROL")),
      command_channel_(bus.channel("COMMAND")) {
  if (!plant_.measure || !plant_.advance || (options_.truth && !plant_.truth))
    throw std::logic_error("a function of the plant's side is missing");
  if (options_.session == 0) options_.session = draw_session();
  report_.session = options_.session;
  const Header header{.n = options_.n, .session = options_.session, .config = options_.config};
  set_header(state_.message, header);
  set_header(truth_.message, header);
  set_header(control_.message, header);
  if (options_.hold) state_.message.flags |= state_t::FLAG_HOLD;
  bus_.subscribe<&LockstepPlant::on_command>(command_channel_, this);
  bus_.subscribe<&LockstepPlant::on_stop>(bus.channel("STOP"), this);
}

Ending LockstepPlant::run() {
  try {
    const Ending ending = run_ticks();
    send_end(end_reason(ending));
    return ending;
  } catch (...) {
    send_end(sim_control_t::REASON_FAULT);
    throw;
  }
}

Ending LockstepPlant::run_ticks() {
  Instant start{0};
  const auto early_ending = [&](std::int64_t tick, Answer answer) {
    if (tick > options_.last_tick) return Ending::finished;  // it only held on
    return answer == Answer::interrupted ? Ending::interrupted : Ending::stopped;
  };

  for (std::int64_t k = 0; before_end(k); ++k) {
    if (k > 0 && pacer_.paced()) {
      if (const Answer a = wait_for_due(k); a != Answer::command) return early_ending(k, a);
    }
    const Instant sent = now();
    if (!publish_state(k)) return Ending::broken_off;
    if (k > 0) publish_truth(k - 1);
    if (const Answer a = wait_for_command(k); a != Answer::command) return early_ending(k, a);

    const Instant arrived = now();
    if (k == 0) {
      start = arrived;
      pacer_.start(arrived);
    } else {
      report_.round_trip.add(arrived - sent);
    }
    if (k <= options_.last_tick) report_.wall_time = arrived - start;
    const bool sound = plant_.advance(k, inbox_.message.tau_commanded);
    report_.ticks_done = k + 1;
    if (!sound) return Ending::broken_off;
  }
  publish_truth(options_.last_tick);
  return Ending::finished;
}

// False where the sensors aren't finite: that tick must not reach the bus.
bool LockstepPlant::publish_state(std::int64_t tick) {
  state_t& message = state_.message;
  message.seq = tick;
  message.utime = plant_time_us(tick, options_.rate_hz);
  plant_.measure(tick, message.psi_measured, message.psid_measured);
  if (!is_finite(message)) return false;
  tick_ = tick;
  command_heard_ = false;
  bus_.publish(state_channel_, state_.encode());
  return true;
}

void LockstepPlant::publish_truth(std::int64_t tick) {
  if (!options_.truth) return;
  truth_t& message = truth_.message;
  message.seq = tick;
  message.utime = plant_time_us(tick, options_.rate_hz);
  plant_.truth(tick, message);
  if (is_finite(message)) bus_.publish(truth_channel_, truth_.encode());
}

LockstepPlant::Answer LockstepPlant::wait_for_command(std::int64_t tick) {
  const nanoseconds longest = tick == 0 ? options_.first_wait : options_.patience;
  std::uint64_t& resent = tick == 0 ? report_.resent_at_start : report_.resent;
  const Instant began = now();
  nanoseconds interval = options_.first_resend;
  Instant resend = began + interval;

  for (;;) {
    const Wake wake = bus_.wait(resend, stop_);
    if (wake == Wake::stop) return Answer::interrupted;
    if (stop_heard_) return Answer::stopped;
    if (command_heard_) {
      stop_listening();
      return Answer::command;
    }
    if (mismatch_heard_ && !controller_agrees_)
      throw RunFault("config_mismatch",
                     "the controller that answers on " + command_channel_ + " was started with another " +
                         name_difference(options_.config, mismatched_config_) + " than this plant");
    if (wake == Wake::message) continue;

    const nanoseconds silence = now() - began;
    if (silence >= longest) lost_peer(tick, longest);
    if (silence >= longest / 4) listen_for_planner();
    bus_.publish(state_channel_, state_.encoded());
    ++resent;
    interval = std::min(2 * interval, options_.slowest_resend);
    resend = std::min(now() + interval, began + longest);
  }
}

// Most of the way the bus is listened to, so that a stop is heard at once; the last stretch is slept
// through by an absolute clock.
LockstepPlant::Answer LockstepPlant::wait_for_due(std::int64_t tick) {
  constexpr auto kLastStretch = std::chrono::milliseconds(2);
  const Instant due = pacer_.due(tick);
  for (;;) {
    if (stop_.turned()) return Answer::interrupted;
    if (stop_heard_) return Answer::stopped;
    if (due - now() <= kLastStretch) break;
    bus_.wait(due - kLastStretch, stop_);
  }
  while (now() < due && !stop_.turned()) sleep_until(due);
  pacer_.began(tick, now());
  report_.slipped = pacer_.slipped();
  return stop_.turned() ? Answer::interrupted : Answer::command;
}

void LockstepPlant::send_end(std::int8_t reason) {
  report_.failed_sends = bus_.failed_sends();
  sim_control_t& message = control_.message;
  message.action = sim_control_t::ACTION_END;
  message.reason = reason;
  message.seq = std::max<std::int64_t>(report_.ticks_done - 1, 0);
  message.utime = plant_time_us(message.seq, options_.rate_hz);
  control_.encode();
  for (int i = 0; i < kEndRepeats; ++i) {
    if (i > 0) sleep_until(now() + kEndInterval);
    bus_.publish(control_channel_, control_.encoded());
  }
}

// REFERENCEs would wake the plant once a tick for nothing: it hears them only to tell who is missing.
void LockstepPlant::listen_for_planner() {
  if (listens_for_planner_) return;
  listens_for_planner_ = true;
  planner_heard_ = false;
  bus_.subscribe<&LockstepPlant::on_reference>(bus_.channel("REFERENCE"), this);
}

void LockstepPlant::stop_listening() {
  if (!listens_for_planner_) return;
  listens_for_planner_ = false;
  bus_.unsubscribe(bus_.channel("REFERENCE"));
}

void LockstepPlant::lost_peer(std::int64_t tick, nanoseconds waited) const {
  const std::string reference_channel = bus_.channel("REFERENCE");
  throw RunFault("lost_peer",
                 "no answer to tick " + std::to_string(tick) + " on " + command_channel_ + " for " +
                     std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(waited).count()) +
                     " ms; " + reference_channel +
                     (planner_heard_ ? " answers, so the controller is missing"
                                     : " is silent too, so the planner is missing, or both are"));
}

void LockstepPlant::on_command(Bytes bytes) {
  const auto reject = [this](Reject cause) { report_.rejects.count(cause); };
  // A second answer to this tick must not overwrite the first, which waits to be applied.
  if (command_heard_) return reject(Reject::stale);
  if (const auto cause = inbox_.read(bytes)) return reject(*cause);
  const command_t& command = inbox_.message;
  if (command.session != options_.session) return reject(Reject::session);
  if (command.config != options_.config) {
    mismatched_config_ = command.config;
    mismatch_heard_ = true;
    return reject(Reject::config);
  }
  if (command.seq < tick_) return reject(Reject::stale);
  if (command.seq > tick_) return reject(Reject::tick);
  controller_agrees_ = true;
  command_heard_ = true;
  if ((command.flags & command_t::FLAG_JOINED_LATE) != 0) ++report_.joined_late;
}

}  // namespace mixloop
