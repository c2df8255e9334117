// SPDX-License-Identifier: MIT
#include "watch/watch.hpp"

#include <cmath>

#include "dynamics/equations.hpp"
#include "runtime/protocol/config_hash.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kTicksKept = 128;  // a reference is one tick ahead, a truth one behind

bool by_tick(Channel channel) {
  return channel == Channel::state || channel == Channel::reference || channel == Channel::command ||
         channel == Channel::truth;
}

const char* ending_of(std::int8_t reason) {
  switch (reason) {
    case sim_control_t::REASON_FINISHED:
      return "finished";
    case sim_control_t::REASON_INTERRUPTED:
      return "interrupted";
    case sim_control_t::REASON_STOPPED:
      return "stopped";
    default:
      return "fault";
  }
}

Heard heard(const Histogram& times) {
  return {
      .count = times.count(), .p50 = times.quantile(0.5), .p99 = times.quantile(0.99), .max = times.max()};
}

std::string why_safe(std::int32_t command_flags) {
  if ((command_flags & command_t::FLAG_WITHOUT_REFERENCE) != 0) return ": it has no reference";
  return (command_flags & command_t::FLAG_AFTERWARDS) != 0 ? ": it hears no newer state" : "";
}

// Types whose finiteness the wire doesn't know have nothing that is compared or drawn with it.
template <class Message>
bool sound(const Message& message) {
  if constexpr (requires { is_finite(message); })
    return is_finite(message);
  else
    return true;
}

}  // namespace

const char* name_of(Channel channel) {
  static constexpr const char* kNames[] = {"STATE",  "REFERENCE",   "COMMAND", "TRUTH",
                                           "TIMING", "SIM_CONTROL", "FAULT",   "STOP"};
  return kNames[static_cast<std::size_t>(channel)];
}

void Extreme::add(double value) {
  now = value;
  if (std::abs(value) > std::abs(worst)) worst = value;
}

Watch::Watch(const std::string& prefix, std::optional<Experiment> experiment, Instant start)
    : experiment_(std::move(experiment)), ticks_(kTicksKept) {
  for (const Channel channel : kChannels)
    counts_.emplace_back(prefix + name_of(channel), by_tick(channel), start);
  if (experiment_)
    kinematics_.emplace(equations_of(experiment_->scene, Evaluation::interpreter, {Purpose::end_effector}),
                        experiment_->plant_parameters);
}

Watch::~Watch() = default;

void Watch::take(Channel channel, Bytes bytes, Instant at) {
  ChannelCount& count = counts_[static_cast<std::size_t>(channel)];
  count.heard(at);
  if (channel == Channel::stop) {  // the channel alone is the message
    stopped_ = true;
    return;
  }
  const auto taken = [&] {
    if (!decode(bytes, message_)) return false;
    switch (channel) {
      case Channel::state:
        return take_as<state_t>(at);
      case Channel::reference:
        return take_as<reference_t>(at);
      case Channel::command:
        return take_as<command_t>(at);
      case Channel::truth:
        return take_as<truth_t>(at);
      case Channel::timing:
        return take_as<timing_t>(at);
      case Channel::sim_control:
        return take_as<sim_control_t>(at);
      default:
        return std::holds_alternative<fault_t>(message_);
    }
  };
  if (!taken()) count.bad();
}

/// Hands the message on where it is of this type, sound, and of the run that is watched.
template <class Message>
bool Watch::take_as(Instant at) {
  const Message* message = std::get_if<Message>(&message_);
  if (!message || message->n < 1 || !sound(*message)) return false;
  if constexpr (std::is_same_v<Message, state_t>)
    if (session_.would_follow(message->session, at) && session_.follow(message->session, at)) begin(*message);
  if (message->session != session_.current()) {
    if (heard_state()) ++other_sessions_;
    return true;
  }
  if (static_cast<std::size_t>(message->n) != n_) return false;
  on(*message, at);
  return true;
}

void Watch::begin(const state_t& state) {
  n_ = static_cast<std::size_t>(state.n);
  for (ChannelCount& count : counts_) count.new_session();
  ticks_.assign(kTicksKept, {});
  latest_ = latest_command_ = -1;
  command_flags_ = truth_flags_ = 0;
  phase_ = reference_t::PHASE_PATH;
  config_ = state.config;
  stopped_ = false;
  ending_.clear();
  timing_.reset();
  intervals_ = answers_ = {};
  forget_the_worst();
  motors_.assign(n_, {});
  if (!experiment_) return;
  const auto& limits =
      experiment_->plant.torque_limit.empty() ? experiment_->limits.torque : experiment_->plant.torque_limit;
  for (std::size_t i = 0; i < std::min(n_, limits.size()); ++i) motors_[i].limit = limits[i];
}

void Watch::forget_the_worst() {
  position_error_.reset();
  for (MotorView& motor : motors_) motor.error.worst = motor.torque.worst = 0;
}

Watch::Tick& Watch::tick(std::int64_t seq) {
  Tick& kept = ticks_[static_cast<std::size_t>(static_cast<std::uint64_t>(seq) % kTicksKept)];
  if (kept.seq != seq) kept = {.seq = seq};
  return kept;
}

void Watch::on(const state_t& state, Instant at) {
  counts_[static_cast<std::size_t>(Channel::state)].tick(state.seq);
  if (state.seq <= latest_) return;
  if (latest_ >= 0) intervals_.add(at - state_at_);
  latest_ = state.seq;
  state_at_ = at;
  state_flags_ = state.flags;
  plant_time_ = 1e-6 * static_cast<double>(state.utime);
  Tick& kept = tick(state.seq);
  kept.utime = state.utime;
  kept.psi = state.psi_measured;
  compare_motors(kept);
}

void Watch::on(const reference_t& reference, Instant) {
  counts_[static_cast<std::size_t>(Channel::reference)].tick(reference.seq);
  Tick& kept = tick(reference.seq);
  if (kept.reference) return;
  kept.reference = reference;
  compare_motors(kept);
  compare_position(kept);
}

void Watch::on(const command_t& command, Instant at) {
  counts_[static_cast<std::size_t>(Channel::command)].tick(command.seq);
  command_flags_ = command.flags;
  if (command.seq == latest_ && command.seq > latest_command_) answers_.add(at - state_at_);
  latest_command_ = std::max(latest_command_, command.seq);
  for (std::size_t i = 0; i < n_; ++i) motors_[i].torque.add(command.tau_commanded[i]);
}

void Watch::on(const truth_t& truth, Instant) {
  counts_[static_cast<std::size_t>(Channel::truth)].tick(truth.seq);
  truth_flags_ = truth.flags;
  for (std::size_t i = 0; i < n_; ++i) motors_[i].applied = truth.tau_applied[i];
  if (kinematics_ || n_ != 3) return;
  Tick& kept = tick(truth.seq);
  kept.utime = truth.utime;
  kept.position = {truth.position[0], truth.position[1], truth.position[2]};
  compare_position(kept);
}

void Watch::on(const timing_t& timing, Instant) { timing_ = timing; }

void Watch::on(const sim_control_t& control, Instant) {
  if (control.action == sim_control_t::ACTION_END) ending_ = ending_of(control.reason);
  // The plant's own says which session comes next; an operator's is for the plant alone.
  if (control.action == sim_control_t::ACTION_RESET && control.seq != 0) session_.go_over_to(control.seq);
}

void Watch::compare_motors(Tick& kept) {
  if (!kept.psi || !kept.reference) return;
  phase_ = kept.reference->phase;
  const bool counts = phase_ != reference_t::PHASE_MOVE_TO_START;
  for (std::size_t i = 0; i < n_; ++i) {
    const double error = kept.reference->psi_desired[i] - (*kept.psi)[i];
    motors_[i].error.now = error;
    if (counts) motors_[i].error.add(error);
  }
  if (!kinematics_ || static_cast<std::size_t>(kinematics_->scene().n()) != n_) return;
  const std::vector<double> zero(n_, 0.0);
  std::vector<double> hand = kinematics_->outputs(Purpose::end_effector);
  const double t = static_cast<double>(kept.seq) / experiment_->rate_hz;
  kinematics_->evaluate(Purpose::end_effector, {*kept.psi, zero, zero, t}, hand);
  kept.position = {hand[0], hand[1], hand[2]};
  compare_position(kept);
}

void Watch::compare_position(Tick& kept) {
  if (!kept.position || !kept.reference || kept.reference->phase == reference_t::PHASE_MOVE_TO_START) return;
  static const std::vector<int> kAll = {0, 1, 2};
  double squared = 0;
  for (const int axis : experiment_ ? experiment_->scene->end_effector.axes : kAll) {
    const auto a = static_cast<std::size_t>(axis);
    const double error = (*kept.position)[a] - kept.reference->position_desired[a];
    squared += error * error;
  }
  if (!position_error_) position_error_.emplace();
  const double worst = position_error_->worst;
  position_error_->add(std::sqrt(squared));
  if (position_error_->worst > worst) worst_at_ = 1e-6 * static_cast<double>(kept.utime);
}

std::string Watch::condition(Instant at) const {
  if (!heard_state()) return "silent";
  if (!ending_.empty()) return "ended";
  if (stopped_) return "stopped";
  if (at - state_at_ > std::chrono::seconds(1)) return "silent";
  if (state_flags_ & state_t::FLAG_SAFE_STATE) return "safe_state";
  if (phase_ == reference_t::PHASE_MOVE_TO_START) return "moving_to_start";
  return phase_ == reference_t::PHASE_HOLD ? "holding" : "on_path";
}

std::vector<std::string> Watch::warnings() const {
  std::vector<std::string> all;
  const auto say = [&all](bool when, const std::string& what) {
    if (when) all.push_back(what);
  };
  if (experiment_ && heard_state()) {
    const std::string difference = name_difference(config_of(common_ground(*experiment_)), config_);
    say(!difference.empty(), "the plant runs another experiment: its " + difference + " differ");
  }
  say(command_flags_ & command_t::FLAG_JOINED_LATE, "the controller joined late");
  say(command_flags_ & command_t::FLAG_LIMITED, "the controller limits its torque");
  const auto ahead = extrapolated_by(command_flags_);
  say(ahead > 0,
      "the planner is late: its reference is extrapolated, by " + std::to_string(ahead) + " ticks");
  say(command_flags_ & command_t::FLAG_SAFE,
      "the controller sends a safe command" + why_safe(command_flags_));
  say(command_flags_ & command_t::FLAG_STOPPED, "the controller has stopped");
  say(truth_flags_ & truth_t::FLAG_SATURATED, "a motor's torque is at its limit");
  say(truth_flags_ & truth_t::FLAG_FAULT, "an injected fault is active");
  say(state_flags_ & state_t::FLAG_STALE, "a sensor's values are stale");
  return all;
}

WatchView Watch::view(Instant at) {
  WatchView view;
  for (ChannelCount& count : counts_) view.channels.push_back(count.view(at));
  view.session = session_.current();
  view.other_sessions = other_sessions_;
  view.tick = std::max<std::int64_t>(latest_, 0);
  view.plant_time = plant_time_;
  view.real_time = state_flags_ & state_t::FLAG_REAL_TIME;
  view.condition = condition(at);
  view.ending = ending_;
  view.warnings = warnings();
  view.position_error = position_error_;
  view.position_source = !position_error_ ? "" : kinematics_ ? "experiment" : "truth";
  view.worst_at = worst_at_;
  view.motors = motors_;
  view.timing = timing_;
  view.state_interval = heard(intervals_);
  view.command_after_state = heard(answers_);
  return view;
}

}  // namespace mixloop
