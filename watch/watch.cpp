// SPDX-License-Identifier: MIT
#include "watch/watch.hpp"

#include <cmath>

#include "dynamics/equations.hpp"
#include "dynamics/scene/coordinate_values.hpp"
#include "loop/position_error.hpp"
#include "runtime/protocol/config_hash.hpp"

namespace mixloop {
namespace {

bool by_tick(Channel channel) {
  return channel == Channel::state || channel == Channel::reference || channel == Channel::command ||
         channel == Channel::truth;
}

Heard heard(const Histogram& times) {
  return {
      .count = times.count(), .p50 = times.quantile(0.5), .p99 = times.quantile(0.99), .max = times.max()};
}

std::string why_safe(std::int32_t command_flags) {
  if ((command_flags & command_t::FLAG_WITHOUT_REFERENCE) != 0) return ": it has no reference";
  return (command_flags & command_t::FLAG_AFTERWARDS) != 0 ? ": it hears no newer state" : "";
}

}  // namespace

void Extreme::add(double value) {
  set(value);
  if (std::abs(value) > std::abs(worst)) worst = value;
  worst_known = true;
}

Watch::Watch(const std::string& prefix, std::optional<Experiment> experiment, Instant start)
    : experiment_(std::move(experiment)) {
  for (std::size_t i = 0; i < kChannelNames.size(); ++i)
    counts_.emplace_back(prefix + kChannelNames[i], by_tick(static_cast<Channel>(i)), start);
  // Where coordinates are switched, psi doesn't say where the end effector is.
  if (experiment_ && !experiment_->plant.partitions)
    kinematics_.emplace(equations_of(experiment_->scene, Evaluation::interpreter, {Purpose::end_effector}),
                        experiment_->plant_parameters);
}

Watch::~Watch() = default;

void Watch::take(Channel channel, Bytes bytes, Instant at) {
  const auto index = static_cast<std::size_t>(channel);
  ChannelCount& count = counts_[index];
  count.heard(at);
  if (channel == Channel::stop) {  // the channel alone is the message
    stopped_ = true;
    return;
  }
  const auto hear_it = [&]<class Message>(const Message& message) {
    if constexpr (requires { on(message, at); })
      return hear(message, count, at);
    else
      return true;  // a fault is for the plant alone
  };
  if (!decode(bytes, message_) || message_.index() != index + 1 || !std::visit(hear_it, message_))
    count.bad();
}

/// Hands the message on where it is sound and of the run that is watched.
template <class Message>
bool Watch::hear(const Message& message, ChannelCount& count, Instant at) {
  if (message.n < 0 || !is_finite(message)) return false;
  if constexpr (std::is_same_v<Message, state_t>)
    if (session_.would_follow(message.session, at) && session_.follow(message.session, {}, at))
      begin(message);
  if (message.session != session_.current()) {
    if (heard_state()) ++other_sessions_;
    return true;
  }
  constexpr bool of_motors = std::is_same_v<Message, command_t> || std::is_same_v<Message, reference_t>;
  const std::size_t n = static_cast<std::size_t>(message.n), measured = of_motors ? n_u_ : n_;
  // TRUTH counts what isn't measured, too.
  if (std::is_same_v<Message, truth_t> ? n < measured : n != measured) return false;
  count.tick(message.seq);
  on(message, at);
  return true;
}

void Watch::begin(const state_t& state) {
  n_ = static_cast<std::size_t>(state.n);
  n_u_ = experiment_ ? std::min(n_, experiment_->scene->motors().size()) : n_;
  for (ChannelCount& count : counts_) count.new_session();
  ticks_.begin(state.session, state.seq);
  latest_ = latest_command_ = -1;
  command_flags_ = truth_flags_ = 0;
  phase_ = reference_t::PHASE_PATH;
  referred_ = false;
  config_ = state.config;
  command_config_.reset();
  reference_config_.reset();
  stopped_ = false;
  ending_.reset();
  timing_.reset();
  intervals_ = answers_ = {};
  forget_the_worst();
  motors_.assign(n_u_, {});
  if (!experiment_) return;
  const auto& limits =
      experiment_->plant.torque_limit.empty() ? experiment_->limits.torque : experiment_->plant.torque_limit;
  for (std::size_t i = 0; i < std::min(n_u_, limits.size()); ++i) motors_[i].limit = limits[i];
  for (std::size_t i = 0; i < std::min(n_u_, experiment_->scene->motors().size()); ++i)
    motors_[i].torque_unit = torque_unit(experiment_->scene->motors()[i].linear);
}

void Watch::forget_the_worst() {
  position_error_.reset();
  for (MotorView& motor : motors_) motor.error.forget_the_worst(), motor.torque.forget_the_worst();
}

void Watch::on(const state_t& state, Instant at) {
  if (state.seq >= latest_) heard_at_ = at;
  if (state.seq <= latest_) return;
  if (latest_ >= 0) intervals_.add(at - state_at_);
  latest_ = state.seq;
  state_at_ = at;
  state_flags_ = state.flags;
  plant_time_ = 1e-6 * static_cast<double>(state.utime);
  if (ticks_.add(state) == Taken::fresh) compare_motors(*ticks_.find(state.seq));
}

void Watch::on(const reference_t& reference, Instant) {
  reference_config_ = reference.config;
  if (reference.config != config_) return;  // who awaits it drops it
  if (ticks_.add(reference) != Taken::fresh) return;
  referred_ = true;
  const HeardTick& tick = *ticks_.find(reference.seq);
  compare_motors(tick);
  compare_with_truth(tick);
}

void Watch::on(const command_t& command, Instant at) {
  command_config_ = command.config;
  if (command.config != config_) return;  // the plant drops it
  command_flags_ = command.flags;
  if (command.seq == latest_ && command.seq > latest_command_) answers_.add(at - state_at_);
  latest_command_ = std::max(latest_command_, command.seq);
  for (std::size_t i = 0; i < n_u_; ++i) motors_[i].torque.add(command.tau_commanded[i]);
}

void Watch::on(const truth_t& truth, Instant) {
  truth_flags_ = truth.flags;
  for (std::size_t i = 0; i < n_u_; ++i) motors_[i].applied = truth.tau_applied[i];
  if (ticks_.add(truth) == Taken::fresh) compare_with_truth(*ticks_.find(truth.seq));
}

void Watch::on(const timing_t& timing, Instant) { timing_ = timing; }

void Watch::on(const sim_control_t& control, Instant) {
  if (control.action == sim_control_t::ACTION_END) ending_ = ending_of(control.reason);
  // The plant's own says which session comes next; an operator's is for the plant alone.
  if (control.action == sim_control_t::ACTION_RESET && control.seq != 0) session_.go_over_to(control.seq);
}

void Watch::compare_motors(const HeardTick& tick) {
  const auto* state = tick.get<state_t>();
  const auto* reference = tick.get<reference_t>();
  if (!state || !reference) return;
  phase_ = reference->phase;
  const bool counts = phase_ != reference_t::PHASE_MOVE_TO_START;
  for (std::size_t i = 0; i < n_u_; ++i) {
    const double error = reference->psi_desired[i] - state->psi_measured[i];
    motors_[i].error.set(error);
    if (counts) motors_[i].error.add(error);
  }
  if (!kinematics_ || static_cast<std::size_t>(kinematics_->scene().n()) != n_) return;
  const std::vector<double> zero(n_, 0.0);
  std::vector<double> hand = kinematics_->outputs(Purpose::end_effector);
  const double t = static_cast<double>(tick.k) / experiment_->rate_hz;
  kinematics_->evaluate(Purpose::end_effector, {state->psi_measured, zero, zero, t}, hand);
  compare_position(Eigen::Map<const Eigen::Vector3d>(hand.data()), *reference, state->utime);
}

void Watch::compare_with_truth(const HeardTick& tick) {
  const auto* truth = tick.get<truth_t>();
  const auto* reference = tick.get<reference_t>();
  if (truth && reference && !kinematics_ && n_ == 3)
    compare_position(Eigen::Map<const Eigen::Vector3d>(truth->position), *reference, truth->utime);
}

void Watch::compare_position(const Eigen::Vector3d& position, const reference_t& reference,
                             std::int64_t utime) {
  if (reference.phase == reference_t::PHASE_MOVE_TO_START) return;
  static const std::vector<int> kAll = {0, 1, 2};
  if (!position_error_) position_error_.emplace();
  const double worst = position_error_->worst_known ? position_error_->worst : -1;
  position_error_->add(position_error(position, Eigen::Map<const Eigen::Vector3d>(reference.position_desired),
                                      experiment_ ? experiment_->scene->end_effector.axes : kAll));
  if (position_error_->worst > worst) worst_at_ = 1e-6 * static_cast<double>(utime);
}

Condition Watch::condition(Instant at) const {
  if (!heard_state()) return Condition::silent;
  if (ending_) return Condition::ended;
  if (stopped_) return Condition::stopped;
  if (at - heard_at_ > std::chrono::seconds(1)) return Condition::silent;
  if (at - state_at_ > std::chrono::seconds(1))
    return latest_command_ < latest_ ? Condition::waiting : Condition::paused;
  if (state_flags_ & state_t::FLAG_SAFE_STATE) return Condition::safe_state;
  // Commands that no reference went before.
  if (experiment_ ? !experiment_->has_path() : !referred_ && latest_command_ > 0) return Condition::moving;
  if (phase_ == reference_t::PHASE_MOVE_TO_START) return Condition::moving_to_start;
  return phase_ == reference_t::PHASE_HOLD ? Condition::holding : Condition::on_path;
}

std::vector<std::string> Watch::warnings(Instant at) const {
  std::vector<std::string> all;
  const auto say = [&all](bool when, const std::string& what) {
    if (when) all.push_back(what);
  };
  if (experiment_ && heard_state()) {
    const std::string difference = name_difference(config_of(common_ground(*experiment_)), config_);
    say(!difference.empty(), "the plant runs another experiment: its " + difference + " differ");
  }
  const auto say_other = [&](const char* who, const std::optional<std::int64_t>& config) {
    if (const std::string difference = config ? name_difference(config_, *config) : ""; !difference.empty())
      all.push_back(std::string("the ") + who + " was started with another " + difference +
                    " than the plant");
  };
  say_other("controller", command_config_);
  say_other("planner", reference_config_);
  if (const std::string dropped = timing_ ? dropped_in(*timing_) : ""; condition(at) == Condition::waiting)
    say(!dropped.empty(), "the plant has dropped " + dropped);
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
  view.warnings = warnings(at);
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
