// SPDX-License-Identifier: MIT
#include "runtime/protocol/planner_peer.hpp"

#include <stdexcept>
#include <utility>

#include "notation/errors.hpp"
#include "runtime/clock/plant_time.hpp"

namespace mixloop {

PlannerPeer::PlannerPeer(Bus& bus, const StopSwitch& stop, const PeerOptions& options, PlannerSide side)
    : bus_(bus),
      options_(options),
      side_(std::move(side)),
      link_(bus, stop, options),
      reference_(options.n_u),
      reference_channel_(bus.channel("REFERENCE")) {
  if (!side_.refer) throw std::logic_error("the planner has no references to give");
}

Ending PlannerPeer::run() {
  for (;;) {
    const PlantLink::Event event = link_.next();
    if (event == PlantLink::Event::over) return link_.ending();
    if (event == PlantLink::Event::other) continue;

    const std::int64_t k = link_.latest();
    const bool fresh = event == PlantLink::Event::fresh;
    if (fresh && link_.first_of_session()) {
      sent_ = -1;
      if (side_.begin) side_.begin(link_.state());
    }
    if (!fresh || sent_ != k) publish(k);
    publish(k + 1);
    sent_ = k + 1;
    ++(fresh ? link_.report.answered : link_.report.repeated);
  }
}

void PlannerPeer::publish(std::int64_t tick) {
  reference_t& message = reference_.message;
  side_.refer(tick, message);
  if (!is_finite(message))
    throw RunFault("not_finite", "the plan has no finite reference for tick " + std::to_string(tick));
  set_header(message, link_.answer_header(tick, plant_time_us(tick, options_.rate_hz)));
  bus_.publish(reference_channel_, reference_.encode());
}

}  // namespace mixloop
