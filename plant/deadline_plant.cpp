// SPDX-License-Identifier: MIT
#include "plant/deadline_plant.hpp"

#include <algorithm>
#include <cmath>

namespace mixloop {

DeadlinePlant::DeadlinePlant(Plant plant, const PlantSettings& settings, DeadlineSettings deadline,
                             double rate_hz, std::int64_t ticks)
    : plant_(std::move(plant)),
      deadline_(std::move(deadline)),
      tick_length_(1.0 / rate_hz),
      delay_(settings.command_delay) {
  state_.commanded = state_.stand = Vector::Zero(static_cast<Eigen::Index>(plant_.applied().size()));
  state_.last_hundred.assign(100, true);
  // Commands are each of another tick: no more of them wait than ticks go into the delay.
  state_.effects.assign(static_cast<std::size_t>(std::ceil(delay_ * rate_hz)) + 4, {.tau = state_.commanded});
  state_.arrivals.commands.reserve(static_cast<std::size_t>(ticks) + 2);
  // Past the limit only what heals something is kept: no more than there is, and than may still begin.
  const Faults::State* faults = plant_.faults();
  const std::size_t healings = faults ? faults->until.size() + faults->waiting.size() + Faults::kWaiting : 0;
  state_.arrivals.interventions.reserve(kInjected + 1 + healings);
}

void DeadlinePlant::put_back(const DeadlineState& state, const PlantState& plant) {
  state_ = state;
  plant_.put_back(plant);
}

void DeadlinePlant::command(Arrival arrival, std::span<const double> tau) {
  if (arrival.command <= state_.newest) return;
  state_.newest = arrival.command;
  arrival.tick = plant_.tick();
  auto& commands = state_.arrivals.commands;
  if (commands.size() < commands.capacity()) commands.push_back(arrival);
  const bool first = arrival.command == 0;
  const double at = first ? 0 : std::max(1e-9 * static_cast<double>(arrival.offset), 0.0) + delay_;
  const double ticks_later = std::floor(at / tick_length_ * (1 + 1e-12));
  queue(plant_.tick() + static_cast<std::int64_t>(ticks_later), at - ticks_later * tick_length_, tau);
}

void DeadlinePlant::queue(std::int64_t tick, double offset, std::span<const double> tau) {
  auto& effects = state_.effects;
  auto& effect = effects[(state_.first + state_.waiting) % effects.size()];
  if (state_.waiting < effects.size()) ++state_.waiting;
  effect.tick = tick;
  effect.offset = std::max(offset, 0.0);
  effect.tau = map_of(tau);
}

void DeadlinePlant::finish_tick() {
  const std::int64_t k = plant_.tick();
  if (safe()) take_safe_torque();
  while (state_.waiting > 0 && state_.effects[state_.first].tick <= k) {
    const auto& effect = state_.effects[state_.first];
    state_.first = (state_.first + 1) % state_.effects.size();
    --state_.waiting;
    if (safe()) continue;
    state_.commanded = effect.tau;
    plant_.take_effect(effect.offset, commanded());
  }
  plant_.finish_tick();
  if (!safe()) count(state_.newest >= k);
}

void DeadlinePlant::count(bool in_time) {
  auto& last_hundred = state_.last_hundred;
  last_hundred[static_cast<std::size_t>(state_.counted++) % last_hundred.size()] = in_time;
  if (in_time) {
    state_.run_of_misses = 0;
    return;
  }
  ++state_.missed;
  state_.longest_miss = std::max(state_.longest_miss, ++state_.run_of_misses);
  if (state_.run_of_misses > deadline_.max_missed) go_safe("commands missed");
}

double DeadlinePlant::success_last_100() const {
  const auto& last_hundred = state_.last_hundred;
  const auto known = std::min<std::int64_t>(state_.counted, static_cast<std::int64_t>(last_hundred.size()));
  if (known == 0) return 1;
  return static_cast<double>(std::count(last_hundred.begin(), last_hundred.begin() + known, true)) /
         static_cast<double>(known);
}

void DeadlinePlant::make_safe(const char* cause) {
  if (safe()) return;
  state_.arrivals.interventions.push_back({.tick = plant_.tick(), .cause = cause});
  go_safe(cause);
}

const char* DeadlinePlant::no_room_for(const Fault& fault, std::span<const Fault> before) const {
  if (plant_.heals_at_once(fault)) return nullptr;
  if (state_.arrivals.interventions.size() + before.size() >= kInjected)
    return "1000 came in this run, and no more are kept of one; what is wrong can still be healed (kind "
           "none, at "
           "once)";
  if (plant_.no_more_may_wait(before.size()))
    return "64 wait for their time, and no more can; what is wrong can still be healed (kind none, at once)";
  return nullptr;
}

bool DeadlinePlant::inject(const Fault& fault) {
  auto& kept = state_.arrivals.interventions;
  if (kept.size() >= kInjected) {
    if (!plant_.heals_at_once(fault)) return false;
    if (!plant_.is_wrong(fault)) return true;  // there is nothing to heal
  }
  if (!plant_.inject(fault)) return false;
  kept.push_back({.tick = plant_.tick(), .fault = fault});
  return true;
}

void DeadlinePlant::go_safe(const char* cause) {
  state_.safe = {.tick = plant_.tick(), .cause = cause};
  state_.stand = map_of(plant_.psi()).head(state_.stand.size());
  if (deadline_.safe_state == SafeState::brake) plant_.lock();
}

void DeadlinePlant::take_safe_torque() {
  Vector& tau = state_.commanded;
  tau.setZero();
  const bool hold = deadline_.safe_state == SafeState::hold;
  if (hold) tau = deadline_.kp.cwiseProduct(state_.stand - map_of(plant_.psi()).head(tau.size()));
  if (hold || deadline_.safe_state == SafeState::damp)
    tau -= deadline_.kv.cwiseProduct(map_of(plant_.psid()).head(tau.size()));
  plant_.take_effect(0, commanded());
}

}  // namespace mixloop
