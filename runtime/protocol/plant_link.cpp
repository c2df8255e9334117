// SPDX-License-Identifier: MIT
#include "runtime/protocol/plant_link.hpp"

#include <utility>

#include "notation/errors.hpp"
#include "runtime/clock/plant_time.hpp"
#include "runtime/protocol/config_hash.hpp"

namespace mixloop {
namespace {

bool holds(const state_t& state) { return (state.flags & state_t::FLAG_HOLD) != 0; }

std::string whole_milliseconds(nanoseconds t) {
  return std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(t).count()) + " ms";
}

}  // namespace

PlantLink::PlantLink(Bus& bus, const StopSwitch& stop, const PeerOptions& options)
    : bus_(bus),
      stop_(stop),
      options_(options),
      state_channel_(bus.channel("STATE")),
      session_(options.session),
      inbox_(options.n),
      control_inbox_(options.n),
      state_(blank<state_t>(options.n)),
      deadline_(now() + options.first_wait) {
  bus_.subscribe<&PlantLink::on_state>(state_channel_, this);
  bus_.subscribe<&PlantLink::on_control>(bus_.channel("SIM_CONTROL"), this);
  bus_.subscribe<&PlantLink::on_stop>(bus_.channel("STOP"), this);
}

PlantLink::Event PlantLink::next(Instant until) {
  heard_ = Event::other;
  const Wake wake = bus_.wait(std::min(deadline_, until), stop_);
  report.failed_sends = bus_.failed_sends();
  session_.plant().tell(state_channel_, options_.notice);
  if (wake == Wake::stop) {
    ending_ = Ending::interrupted;
    return Event::over;
  }
  // What is not the plant's does not put off that it is missed.
  if (wake == Wake::message)
    if (const Event event = judge(); event != Event::other || now() < deadline_) return event;
  return now() < deadline_ ? Event::nothing : silence();
}

PlantLink::Event PlantLink::silence() {
  if (latest() >= options_.last_tick && !holds(state_)) return Event::over;  // its END got lost
  if (agreement_.contradicted()) refuse_config();
  const std::string waited =
      session_.heard() ? whole_milliseconds(options_.patience) + " after tick " + std::to_string(latest())
                       : whole_milliseconds(options_.first_wait);
  if (dropped_.rejects().total() == 0)
    throw RunFault("lost_peer", "nothing on " + state_channel_ + " for " + waited + ": the plant is missing");
  const Header expected{
      .n = options_.n, .seq = latest() + 1, .session = session_.current(), .config = options_.config};
  throw RunFault("lost_peer", "nothing that can be taken on " + state_channel_ + " for " + waited +
                                  "; dropped there: " + dropped_.text(expected) +
                                  (dropped_.are_answers() ? ": a plant is there, but not one for this process"
                                                          : ": the plant is missing"));
}

PlantLink::Event PlantLink::judge() {
  if (stop_heard_) {
    ending_ = Ending::stopped;
    return Event::over;
  }
  if (end_heard_) return Event::over;
  if (agreement_.refuted()) refuse_config();
  return heard_;
}

void PlantLink::refuse_config() const {
  const std::int64_t mine = options_.config, theirs = agreement_.theirs();
  throw RunFault("config_mismatch", "the plant on " + state_channel_ + " was started with another " +
                                        name_difference(mine, theirs) + " than this process: " +
                                        describe_difference(mine, theirs, options_.config_words) +
                                        "; start both with the same experiment and the same --set");
}

Header PlantLink::answer_header(std::int64_t tick, std::int64_t utime) const {
  return {.n = options_.n_u,
          .utime = utime,
          .seq = tick,
          .session = session_.current(),
          .config = options_.config};
}

std::optional<Reject> PlantLink::check_origin(std::int64_t session, std::int64_t config) const {
  if (session == 0 || session != session_.current()) return Reject::session;
  if (config != options_.config) return Reject::config;
  return std::nullopt;
}

void PlantLink::on_state(const Received& message) {
  const Instant at = now();
  if (const auto cause = check_state(message, at)) {
    report.rejects.count(*cause);
    dropped_.count(*cause, message.data);
    return;
  }
  const state_t& heard = inbox_.message;
  deadline_ = at + options_.patience;
  dropped_.forget();
  const bool first = session_.follow(heard.session, message, at);
  if (!first && heard.seq == latest()) {
    heard_ = Event::repeated;
    return;
  }
  std::swap(state_, inbox_.message);
  heard_ = Event::fresh;
  first_of_session_ = first;
  report.latest = state_.seq;
  report.session = state_.session;
  if (first) report.joined_late = state_.seq > 0;
}

/// Also of a message that is dropped it is heard what its sender was started with: n goes with the mechanism.
std::optional<Reject> PlantLink::check_state(const Received& message, Instant at) {
  const Bytes bytes = message.data;
  const auto header = peek(bytes);
  const bool ours =
      header && fingerprint(bytes) == state_t::getHash() && session_.would_follow(header->session, at);
  const bool agrees = ours && agreement_.hears(options_.config, header->config);
  if (const auto cause = inbox_.read(bytes)) return cause;
  if (!ours) return Reject::session;
  if (!agrees) return Reject::config;
  const state_t& heard = inbox_.message;
  if (heard.seq < 0 || heard.seq > kFarthestTick || (heard.seq > options_.last_tick && !holds(heard)))
    return Reject::tick;
  SoleSender& plant = session_.plant();
  const bool followed = plant.heard() && heard.session == report.session;
  const bool of_plant = session_.is_the_plants(message.sender);
  if (followed && heard.seq < latest() && (of_plant || !plant.silent(at))) return Reject::stale;
  if (!session_.would_follow(heard.session, message.sender, at)) {
    plant.refuse(message.sender, heard.seq);
    return Reject::sender;
  }
  if (followed && of_plant && heard.seq == latest() && plant.contradicts(message, heard.seq))
    return Reject::sender;
  return std::nullopt;
}

void PlantLink::on_control(const Received& message) {
  const auto reject = [this](Reject cause) { report.rejects.count(cause); };
  if (const auto cause = control_inbox_.read(message.data)) return reject(*cause);
  const sim_control_t& control = control_inbox_.message;
  if (const auto cause = check_origin(control.session, control.config)) return reject(*cause);
  // The plant's own RESET says which session comes next; an operator's is for the plant alone.
  const bool is_reset = control.action == sim_control_t::ACTION_RESET && control.seq != 0;
  if (!is_reset && control.action != sim_control_t::ACTION_END) return;
  if (!session_.is_the_plants(message.sender)) return reject(Reject::sender);
  if (is_reset) return session_.go_over_to(control.seq);
  end_heard_ = true;
  ending_ = ending_of(control.reason);
}

}  // namespace mixloop
