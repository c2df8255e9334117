// SPDX-License-Identifier: MIT
#include "runtime/controller_peer.hpp"

#include <stdexcept>
#include <utility>

#include "notation/errors.hpp"
#include "runtime/config_hash.hpp"

namespace mixloop {

ControllerPeer::ControllerPeer(Bus& bus, const StopSwitch& stop, const PeerOptions& options,
                               ControllerSide side)
    : bus_(bus),
      options_(options),
      side_(std::move(side)),
      link_(bus, stop, options),
      inbox_(options.n),
      command_(options.n),
      reference_channel_(bus.channel("REFERENCE")),
      command_channel_(bus.channel("COMMAND")),
      ring_(kAhead, Kept{.tick = -1, .message = blank<reference_t>(options.n)}) {
  if (!side_.compute) throw std::logic_error("the controller has no law to compute");
  bus_.subscribe<&ControllerPeer::on_reference>(reference_channel_, this);
}

Ending ControllerPeer::run() {
  for (;;) {
    switch (link_.next()) {
      case PlantLink::Event::over:
        return link_.ending();
      case PlantLink::Event::fresh:
        if (link_.first_of_session()) begin_session();
        asked_ = now();
        break;
      case PlantLink::Event::repeated:
        repeat();
        break;
      case PlantLink::Event::other:
        break;
    }
    require_planner();
    answer_if_ready();
  }
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
  const state_t& state = link_.state();
  const std::int64_t tick = link_.latest();
  if (tick <= answered_) return;
  const Kept& reference = kept(tick);
  if (reference.tick != tick) return;

  command_t& message = command_.message;
  side_.compute(tick, state.psi_measured, state.psid_measured, reference.message, message.tau_commanded);
  if (!is_finite(message))
    throw RunFault("not_finite", "the control law gives no finite torque at tick " + std::to_string(tick));
  set_header(message, link_.answer_header(tick, state.utime));
  message.flags = link_.report.joined_late ? command_t::FLAG_JOINED_LATE : 0;
  bus_.publish(command_channel_, command_.encode());
  answered_ = tick;
  ++link_.report.answered;
}

void ControllerPeer::repeat() {
  if (link_.latest() != answered_) return;
  bus_.publish(command_channel_, command_.encoded());
  ++link_.report.repeated;
}

// At the start the plant decides how long all wait for each other; later a planner that is silent while the
// plant goes on asking is lost.
void ControllerPeer::require_planner() const {
  if (planner_differs_ && !planner_agreed_)
    throw RunFault("config_mismatch", "the planner on " + reference_channel_ + " was started with another " +
                                          name_difference(options_.config, planner_config_) +
                                          " than this process");
  if (answered_ < 0 || link_.latest() <= answered_) return;
  if (now() - asked_ < options_.patience) return;
  throw RunFault("lost_peer", "no reference for tick " + std::to_string(link_.latest()) + " on " +
                                  reference_channel_ +
                                  " while the plant goes on asking: the planner is missing");
}

void ControllerPeer::on_reference(Bytes bytes) {
  const auto reject = [this](Reject cause) { link_.report.rejects.count(cause); };
  if (const auto cause = inbox_.read(bytes)) return reject(*cause);
  const reference_t& heard = inbox_.message;
  if (const auto cause = link_.check_origin(heard.session, heard.config)) {
    if (*cause == Reject::config) {
      planner_config_ = heard.config;
      planner_differs_ = true;
    }
    return reject(*cause);
  }
  planner_agreed_ = true;
  if (heard.seq < 0) return reject(Reject::tick);
  if (heard.seq <= answered_) return reject(Reject::stale);
  if (heard.seq >= std::max<std::int64_t>(link_.latest(), 0) + kAhead) return reject(Reject::tick);
  Kept& slot = kept(heard.seq);
  if (slot.tick == heard.seq && slot.message.session == heard.session) return reject(Reject::stale);
  slot.tick = heard.seq;
  std::swap(slot.message, inbox_.message);
}

}  // namespace mixloop
