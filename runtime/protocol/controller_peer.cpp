// SPDX-License-Identifier: MIT
#include "runtime/protocol/controller_peer.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "notation/errors.hpp"
#include "runtime/protocol/config_hash.hpp"

namespace mixloop {
namespace {

constexpr double kReferenceWait = 0.25;  // ticks: what is missing by then is extrapolated

}  // namespace

ControllerPeer::ControllerPeer(Bus& bus, const StopSwitch& stop, const PeerOptions& options,
                               ControllerSide side)
    : bus_(bus),
      options_(options),
      side_(std::move(side)),
      link_(bus, stop, options),
      inbox_(options.n_u),
      command_(options.n_u),
      safe_(options.n_u),
      reference_channel_(bus.channel("REFERENCE")),
      command_channel_(bus.channel("COMMAND")),
      ring_(kAhead, Kept{.tick = -1, .message = blank<reference_t>(options.n_u)}),
      none_(blank<reference_t>(options.n_u)) {
  if (!side_.compute) throw std::logic_error("the controller has no law to compute");
  if (options_.references) bus_.subscribe<&ControllerPeer::on_reference>(reference_channel_, this);
}

Ending ControllerPeer::run() {
  for (;;) {
    const PlantLink::Event event = link_.next(next_look());
    drained_ = event == PlantLink::Event::nothing;
    switch (event) {
      case PlantLink::Event::over:
        if (link_.ending() == Ending::stopped && in_real_time())
          send_safe_afterwards(command_t::FLAG_STOPPED);
        return link_.ending();
      case PlantLink::Event::fresh:
        if (link_.first_of_session()) begin_session();
        asked_ = now();
        dropped_.forget();
        silence_answered_ = false;
        break;
      case PlantLink::Event::repeated:
        repeat();
        break;
      case PlantLink::Event::other:
      case PlantLink::Event::nothing:
        break;
    }
    require_planner();
    planner_.tell(reference_channel_, options_.notice);
    if (in_real_time())
      attend_to_time();
    else
      answer_if_ready();
  }
}

nanoseconds ControllerPeer::ticks(double number) const {
  return nanoseconds(std::llround(1e9 * number / options_.rate_hz));
}

void ControllerPeer::begin_session() {
  const state_t& state = link_.state();
  if (state.seq > 0 && side_.has_memory)
    throw RunFault("joined_late", "first heard this session at tick " + std::to_string(state.seq) +
                                      ", and the control law needs all ticks since 0: restart the plant");
  // References that came before the first STATE of a given session are kept: they are of this session.
  for (Kept& k : ring_)
    if (k.message.session != state.session) k.tick = -1;
  answered_ = -1;
  if (side_.begin) side_.begin(state);
}

void ControllerPeer::answer_if_ready() {
  const std::int64_t tick = link_.latest();
  if (tick <= answered_) return;
  if (!options_.references) return answer_without_reference(tick);
  const Kept& reference = kept(tick);
  if (reference.tick == tick) answer(reference.message);
}

void ControllerPeer::answer_without_reference(std::int64_t tick) {
  none_.seq = tick;
  answer(none_);
}

void ControllerPeer::answer(const reference_t& reference) {
  const state_t& state = link_.state();
  const std::int64_t tick = state.seq, ahead = tick - reference.seq;
  command_t& message = command_.message;
  const std::int32_t flags =
      side_.compute(state, reference, ahead, message.tau_commanded) | extrapolation_flags(ahead);
  if (!is_finite(message))
    throw RunFault("not_finite", "the control law gives no finite torque at tick " + std::to_string(tick));
  set_header(message, link_.answer_header(tick, state.utime));
  message.flags = flags | (link_.report.joined_late ? command_t::FLAG_JOINED_LATE : 0);
  bus_.publish(command_channel_, command_.encode());
  if (!in_real_time()) bus_.expect_answer();  // the next STATE
  answered_ = tick;
  ++link_.report.answered;
}

// When to look again though nothing is received.
Instant ControllerPeer::next_look() const {
  if (link_.latest() < 0 || !in_real_time() || at_the_gate()) return Instant::max();
  if (link_.latest() > answered_) return drained_ ? asked_ + ticks(kReferenceWait) : now();
  return silence_answered_ ? Instant::max() : asked_ + ticks(options_.max_missed);
}

void ControllerPeer::attend_to_time() {
  if (at_the_gate()) return answer_if_ready();
  if (!drained_ && now() - asked_ < ticks(kReferenceWait)) return;  // however much comes
  const std::int64_t tick = link_.latest();
  if (tick <= answered_) {
    if (!silence_answered_ && now() - asked_ >= ticks(options_.max_missed)) {
      silence_answered_ = true;
      send_safe_afterwards(0);
    }
    return;
  }
  answer_if_ready();
  if (tick <= answered_ || now() - asked_ < ticks(kReferenceWait)) return;
  if (const reference_t* reference = newest_before(tick)) {
    ++link_.report.extrapolated;
    return answer(*reference);
  }
  answer_safely();
}

const reference_t* ControllerPeer::newest_before(std::int64_t tick) const {
  const Kept* newest = nullptr;
  for (const Kept& k : ring_)
    if (k.tick >= 0 && k.tick < tick && (newest == nullptr || k.tick > newest->tick)) newest = &k;
  const std::int64_t farthest = std::min<std::int64_t>(options_.max_missed, kFarthestExtrapolated);
  return newest != nullptr && tick - newest->tick <= farthest ? &newest->message : nullptr;
}

void ControllerPeer::answer_safely() {
  fill_safe(command_.message, command_t::FLAG_WITHOUT_REFERENCE);
  bus_.publish(command_channel_, command_.encode());
  answered_ = link_.latest();
  ++link_.report.safe_commands;
}

// Where the answer itself got lost the plant may take this in its place: it says how that came to be.
void ControllerPeer::send_safe_afterwards(std::int32_t flags) {
  const bool answered = answered_ == link_.latest();
  const std::int32_t before = answered ? command_.message.flags | command_t::FLAG_AFTERWARDS
                                       : std::int32_t{command_t::FLAG_WITHOUT_REFERENCE};
  fill_safe(safe_.message, before | flags);
  bus_.publish(command_channel_, safe_.encode());
  ++link_.report.safe_commands;
}

void ControllerPeer::fill_safe(command_t& message, std::int32_t flags) const {
  if (side_.safe)
    side_.safe(message.tau_commanded);
  else
    std::fill(message.tau_commanded.begin(), message.tau_commanded.end(), 0.0);
  set_header(message, link_.answer_header(link_.latest(), link_.state().utime));
  message.flags = flags | command_t::FLAG_SAFE;
}

void ControllerPeer::repeat() {
  if (link_.latest() != answered_) return;
  bus_.publish(command_channel_, command_.encoded());
  ++link_.report.repeated;
}

// At the start the plant decides how long all wait for each other; later a planner that is silent while the
// plant goes on asking is lost.
void ControllerPeer::require_planner() const {
  const bool overdue = answered_ >= 0 && link_.latest() > answered_ && now() - asked_ >= options_.patience;
  if (planner_agreement_.refuted() || (overdue && planner_agreement_.contradicted())) {
    const std::int64_t mine = options_.config, theirs = planner_agreement_.theirs();
    throw RunFault("config_mismatch", "the planner on " + reference_channel_ + " was started with another " +
                                          name_difference(mine, theirs) + " than this process: " +
                                          describe_difference(mine, theirs, options_.config_words) +
                                          "; start both with the same experiment and the same --set");
  }
  if (overdue) lost_planner();
}

void ControllerPeer::lost_planner() const {
  const Header expected{
      .n = options_.n_u, .seq = link_.latest(), .session = link_.session(), .config = options_.config};
  const std::string dropped = dropped_.text(expected);
  throw RunFault("lost_peer",
                 "no reference for tick " + std::to_string(link_.latest()) + " on " + reference_channel_ +
                     " while the plant goes on asking" +
                     (dropped.empty() ? "" : "; dropped there: " + dropped) +
                     (dropped_.are_answers() ? ": the planner is there, but what it sends can't be taken"
                                             : ": the planner is missing"));
}

void ControllerPeer::on_reference(const Received& message) {
  const Instant at = now();
  if (const auto cause = check_reference(message, at)) {
    link_.report.rejects.count(*cause);
    dropped_.count(*cause, message.data);
    return;
  }
  planner_.take(message, at);
  taken_ = header_of(inbox_.message);
  Kept& slot = kept(inbox_.message.seq);
  slot.tick = inbox_.message.seq;
  std::swap(slot.message, inbox_.message);
}

/// Also of a message that is dropped it is heard what its sender was started with: n goes with the mechanism.
std::optional<Reject> ControllerPeer::check_reference(const Received& message, Instant at) {
  const Bytes bytes = message.data;
  if (const auto header = peek(bytes); header && fingerprint(bytes) == reference_t::getHash() &&
                                       link_.check_origin(header->session, header->config) != Reject::session)
    planner_agreement_.hears(options_.config, header->config);
  if (const auto cause = inbox_.read(bytes)) return cause;
  const reference_t& heard = inbox_.message;
  if (const auto cause = link_.check_origin(heard.session, heard.config)) return cause;
  if (heard.seq < 0) return Reject::tick;
  const bool of_this_session = heard.session == link_.state().session;
  const bool is_newest = heard.session == taken_.session && heard.seq == taken_.seq;
  if (of_this_session && heard.seq <= answered_ && !is_newest) return Reject::stale;
  if (!planner_.admits(message.sender, at)) {
    planner_.refuse(message.sender, heard.seq);
    return Reject::sender;
  }
  if (is_newest && planner_.contradicts(message, heard.seq)) return Reject::sender;
  if (of_this_session && heard.seq <= answered_) return Reject::stale;
  if (heard.seq >= std::max<std::int64_t>(link_.latest(), 0) + kAhead) return Reject::tick;
  const Kept& slot = kept(heard.seq);
  if (slot.tick == heard.seq && slot.message.session == heard.session) return Reject::stale;
  return std::nullopt;
}

}  // namespace mixloop
