// SPDX-License-Identifier: MIT
#include "runtime/protocol/plant_port.hpp"

#include <algorithm>
#include <utility>

#include "notation/errors.hpp"
#include "runtime/clock/plant_time.hpp"
#include "runtime/protocol/config_hash.hpp"
#include "runtime/protocol/session.hpp"

namespace mixloop {
namespace {

// Long enough to be sent five times more when datagrams get lost, short enough not to be noticed.
constexpr int kRepeats = 6;
constexpr auto kRepeatInterval = std::chrono::milliseconds(1);
// A controller that had agreed and is heard to differ may only have been doubled: the right one has so long.
constexpr auto kLongSilence = std::chrono::seconds(1);
// A plant that is held by the operator goes on being heard.
constexpr auto kHeldInterval = std::chrono::milliseconds(100);

bool is_safe(const command_t& command) { return (command.flags & command_t::FLAG_SAFE) != 0; }

PlantOptions with_session(PlantOptions options) {
  if (options.session == 0) options.session = draw_session();
  return options;
}

}  // namespace

PlantPort::PlantPort(Bus& bus, const StopSwitch& stop, const PlantOptions& options, PlantSide& plant,
                     std::int32_t state_flags, nanoseconds slack)
    : bus_(bus),
      stop_(stop),
      options_(with_session(options)),
      plant_(plant),
      state_flags_(state_flags | (options.hold ? state_t::FLAG_HOLD : 0)),
      pacer_(options.rate_hz, options.speed, slack),
      conductor_(options.n, options_.session, options.paused, (state_flags & state_t::FLAG_REAL_TIME) != 0),
      state_(options.n),
      truth_(options.n + options.unmeasured),
      control_(options.n),
      timing_(bus, {.n = options.n}),
      inbox_(options.n_u),
      state_channel_(bus.channel("STATE")),
      truth_channel_(bus.channel("TRUTH")),
      control_channel_(bus.channel("SIM_CONTROL")),
      command_channel_(bus.channel("COMMAND")) {
  report.session = options_.session;
  const Header header{.n = options_.n, .session = options_.session, .config = options_.config};
  set_header(state_.message, header);
  set_header(truth_.message,
             {.n = options_.n + options_.unmeasured, .session = options_.session, .config = options_.config});
  set_header(control_.message, header);
  bus_.subscribe<&PlantPort::on_command>(command_channel_, this);
  bus_.subscribe<&PlantPort::on_control>(control_channel_, this);
  bus_.subscribe<&PlantPort::on_stop>(bus.channel("STOP"), this);
}

PlantPort::~PlantPort() {
  stop_listening();
  for (const char* name : {"COMMAND", "SIM_CONTROL", "STOP"}) bus_.unsubscribe(bus_.channel(name));
}

bool PlantPort::publish_state(std::int64_t tick, std::int32_t flags) {
  state_t& message = state_.message;
  message.seq = tick;
  message.utime = plant_time_us(tick, options_.rate_hz);
  const bool stale = plant_.measure(tick, message.psi_measured, message.psid_measured);
  message.flags = state_flags_ | flags | (stale ? state_t::FLAG_STALE : 0);
  if (!is_finite(message)) return false;
  tick_ = tick;
  sent_ = now();
  dropped_.forget();
  bus_.publish(state_channel_, state_.encode());
  bus_.expect_answer();
  return true;
}

void PlantPort::publish_truth(std::int64_t tick, std::int32_t flags) {
  if (!options_.truth) return;
  truth_t& message = truth_.message;
  message.seq = tick;
  message.utime = plant_time_us(tick, options_.rate_hz);
  plant_.truth(tick, message);
  message.flags |= flags;
  if (is_finite(message)) bus_.publish(truth_channel_, truth_.encode());
}

void PlantPort::publish_timing(const DeadlineCounts& deadlines) {
  deadlines_ = deadlines;
  if (timing_.send_where_due(bus_, header_of(state_.message), report, deadlines))
    report.dropped = bus_.dropped();
}

void PlantPort::send_end(Ending ending) {
  report.failed_sends = bus_.failed_sends();
  report.dropped = bus_.dropped();
  sim_control_t& message = control_.message;
  message.action = sim_control_t::ACTION_END;
  message.reason = end_reason(ending);
  message.seq = std::max<std::int64_t>(report.ticks_done - 1, 0);
  message.utime = plant_time_us(message.seq, options_.rate_hz);
  send_repeatedly();
}

void PlantPort::send_reset(std::int64_t next) {
  sim_control_t& message = control_.message;
  message.action = sim_control_t::ACTION_RESET;
  message.seq = next;
  send_repeatedly();
}

void PlantPort::send_repeatedly() {
  control_.encode();
  for (int i = 0; i < kRepeats; ++i) {
    if (i > 0) sleep_until(now() + kRepeatInterval);
    bus_.publish(control_channel_, control_.encoded());
  }
}

PlantPort::Answer PlantPort::asked() const {
  if (stop_.turned()) return Answer::interrupted;
  if (stop_heard_) return Answer::stopped;
  if (conductor_.reset_asked()) return Answer::reset;
  return Answer::due;
}

PlantPort::Answer PlantPort::wait_for_command() {
  const nanoseconds longest = tick_ == 0 ? options_.first_wait : options_.patience;
  std::uint64_t& resent = tick_ == 0 ? report.resent_at_start : report.resent;
  const Instant began = now();
  nanoseconds interval = options_.first_resend;
  Instant resend = began + interval;
  if (tick_ == 0) listen_for_plants();

  for (;;) {
    if (const Answer answer = wait_until(resend); answer != Answer::due) {
      if (answer == Answer::command) stop_listening();
      return answer;
    }
    const nanoseconds silence = now() - began;
    if (silence >= std::min<nanoseconds>(kLongSilence, longest) && agreement_.contradicted()) refuse_config();
    if (silence >= longest) lost_peer(longest);
    if (silence >= longest / 4) listen_for_planner();
    bus_.publish(state_channel_, state_.encoded());
    publish_timing(deadlines_);
    ++resent;
    interval = std::min(2 * interval, options_.slowest_resend);
    resend = std::min(now() + interval, began + longest);
  }
}

PlantPort::Answer PlantPort::wait_until(Instant due) {
  for (;;) {
    if (std::exchange(command_heard_, false)) return Answer::command;
    const Wake wake = bus_.wait(due, stop_);
    report.rival = controller_.rival();
    controller_.tell(command_channel_, options_.notice);
    if (const Answer answer = asked(); answer != Answer::due) return answer;
    require_agreement();
    if (!command_heard_ && (wake == Wake::deadline || now() >= due)) return Answer::due;
  }
}

// Most of the way the bus is listened to, so that a stop is heard at once; the last stretch is slept
// through by an absolute clock.
PlantPort::Answer PlantPort::wait_for_due(std::int64_t tick) {
  constexpr auto kLastStretch = std::chrono::milliseconds(2);
  if (const auto speed = conductor_.new_speed())
    pacer_.go_on(tick, pacer_.paced() ? pacer_.due(tick) : now(), *speed);
  if (!conductor_.lets_go()) {
    if (const Answer answer = wait_while_held(); answer != Answer::due) return answer;
    pacer_.go_on(tick, now(), conductor_.new_speed().value_or(pacer_.speed()));
  }
  if (!pacer_.paced()) return Answer::due;
  const Instant due = pacer_.due(tick);
  while (due - now() > kLastStretch)
    if (const Answer answer = wait_until(due - kLastStretch);
        answer != Answer::due && answer != Answer::command)
      return answer;
  if (const Answer answer = asked(); answer != Answer::due) return answer;
  while (now() < due && !stop_.turned()) bus_.wait_out(due, stop_);
  return began(tick);
}

PlantPort::Answer PlantPort::began(std::int64_t tick) {
  const Instant at = now();
  last_late_ = std::max(at - pacer_.due(tick), nanoseconds(0));
  report.wake_up.add(last_late_);
  pacer_.began(tick, at);
  if (pacer_.slipped() > report.slipped) ++report.overruns;
  report.slipped = pacer_.slipped();
  return stop_.turned() ? Answer::interrupted : Answer::due;
}

// A command that comes meanwhile is left for the tick that begins then.
PlantPort::Answer PlantPort::wait_while_held() {
  Instant repeat = now() + kHeldInterval;
  do {
    const Wake wake = bus_.wait(repeat, stop_);
    if (const Answer answer = asked(); answer != Answer::due) return answer;
    require_agreement();
    if (wake != Wake::deadline && now() < repeat) continue;
    bus_.publish(state_channel_, state_.encoded());
    publish_timing(deadlines_);
    repeat = now() + kHeldInterval;
  } while (!conductor_.lets_go());
  return Answer::due;
}

// REFERENCEs would wake the plant once a tick for nothing: it hears them only to tell who is missing.
void PlantPort::listen_for_planner() {
  if (!options_.references || std::exchange(listens_for_planner_, true)) return;
  planner_heard_ = false;
  bus_.subscribe<&PlantPort::on_reference>(bus_.channel("REFERENCE"), this);
}

// Nor does it listen for others of its kind once it has a controller.
void PlantPort::listen_for_plants() {
  if (std::exchange(listens_for_plants_, true)) return;
  bus_.subscribe<&PlantPort::on_state>(state_channel_, this);
}

void PlantPort::stop_listening() {
  if (std::exchange(listens_for_planner_, false)) bus_.unsubscribe(bus_.channel("REFERENCE"));
  if (std::exchange(listens_for_plants_, false)) bus_.unsubscribe(state_channel_);
}

void PlantPort::require_agreement() const {
  if (agreement_.refuted()) refuse_config();
}

void PlantPort::refuse_config() const {
  const std::int64_t mine = options_.config, theirs = agreement_.theirs();
  throw RunFault("config_mismatch",
                 "the controller that answers on " + command_channel_ + " was started with another " +
                     name_difference(mine, theirs) +
                     " than this plant: " + describe_difference(mine, theirs, options_.config_words) +
                     "; start both with the same experiment and the same --set");
}

void PlantPort::lost_peer(nanoseconds waited) const {
  const Header expected{
      .n = options_.n_u, .seq = tick_, .session = options_.session, .config = options_.config};
  const std::string dropped = dropped_.text(expected);
  const std::string reference_channel = bus_.channel("REFERENCE");
  throw RunFault(
      "lost_peer",
      "no answer to tick " + std::to_string(tick_) + " on " + command_channel_ + " for " +
          std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(waited).count()) + " ms; " +
          (dropped.empty() ? "" : "dropped there: " + dropped + "; ") +
          (dropped_.are_answers() ? "the controller is there, but what it answers can't be taken"
           : !options_.references ? "the controller is missing"
           : planner_heard_       ? reference_channel + " answers, so the controller is missing"
                            : reference_channel + " is silent too, so the planner is missing, or both are") +
          (other_plant_.empty() ? "" : "; " + other_plant_));
}

void PlantPort::on_command(const Received& message) {
  const Instant at = now();
  if (const auto cause = check_command(message, at)) {
    report.rejects.count(*cause);
    dropped_.count(*cause, message.data);
    return;
  }
  controller_.take(message, at);
  taken_.reset();
  if (!is_safe(inbox_.message)) taken_ = inbox_.message.seq;
  command_heard_ = true;
  if ((inbox_.message.flags & command_t::FLAG_JOINED_LATE) != 0) ++report.joined_late;
}

/// Also of a message that is dropped it is heard what its sender was started with: n goes with the mechanism.
std::optional<Reject> PlantPort::check_command(const Received& message, Instant at) {
  const Bytes bytes = message.data;
  // Another answer must not overwrite one that waits to be applied.
  if (command_heard_) return Reject::stale;
  if (const auto header = peek(bytes);
      header && fingerprint(bytes) == command_t::getHash() && header->session == options_.session)
    agreement_.hears(options_.config, header->config);
  if (const auto cause = inbox_.read(bytes)) return cause;
  const command_t& command = inbox_.message;
  if (command.session != options_.session) return Reject::session;
  if (command.config != options_.config) return Reject::config;
  if (command.seq > tick_) return Reject::tick;
  if (command.seq < oldest_ && command.seq != taken_) return Reject::stale;
  if (!controller_.admits(message.sender, at)) {
    controller_.refuse(message.sender, command.seq);
    return Reject::sender;
  }
  // A safe command beside an answer is the same controller's.
  if (command.seq == taken_ && !is_safe(command) && controller_.contradicts(message, command.seq))
    return Reject::sender;
  if (command.seq < oldest_) return Reject::stale;
  return std::nullopt;
}

/// Its own, too.
void PlantPort::on_state(const Received& message) {
  const auto header = peek(message.data);
  if (!header || fingerprint(message.data) != state_t::getHash()) return;
  if (header->session == 0 || header->session == options_.session || !other_plant_.empty()) return;
  other_plant_ = "another plant is on " + state_channel_ + ": session " + std::to_string(header->session) +
                 " from " + to_string(message.sender) +
                 "; a controller follows one of both: give one of them another --channel-prefix";
  if (options_.notice) options_.notice(other_plant_);
}

void PlantPort::on_control(Bytes bytes) {
  const auto cause = conductor_.hear(bytes);
  if (!cause) return;
  report.rejects.count(*cause);
  const char* reason = conductor_.objection();
  if (reason != nullptr && options_.notice && !std::exchange(speed_told_, true))
    options_.notice(std::string("SIM_CONTROL asks for a speed that can't be: ") + reason);
}

}  // namespace mixloop
