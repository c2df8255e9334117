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
      delay_(settings.command_delay),
      commanded_(Vector::Zero(static_cast<Eigen::Index>(plant_.applied().size()))),
      stand_(commanded_),
      last_hundred_(100, true) {
  // Commands are each of another tick: no more of them wait than ticks go into the delay.
  effects_.assign(static_cast<std::size_t>(std::ceil(delay_ * rate_hz)) + 4, Effect{.tau = commanded_});
  arrivals_.commands.reserve(static_cast<std::size_t>(ticks) + 2);
  arrivals_.interventions.reserve(kInjected + 1);
}

void DeadlinePlant::command(Arrival arrival, std::span<const double> tau) {
  if (arrival.command <= newest_) return;
  newest_ = arrival.command;
  arrival.tick = plant_.tick();
  auto& commands = arrivals_.commands;
  if (commands.size() < commands.capacity()) commands.push_back(arrival);
  const bool first = arrival.command == 0;
  const double at = first ? 0 : std::max(1e-9 * static_cast<double>(arrival.offset), 0.0) + delay_;
  const double ticks_later = std::floor(at / tick_length_ * (1 + 1e-12));
  queue(plant_.tick() + static_cast<std::int64_t>(ticks_later), at - ticks_later * tick_length_, tau);
}

void DeadlinePlant::queue(std::int64_t tick, double offset, std::span<const double> tau) {
  Effect& effect = effects_[(first_ + waiting_) % effects_.size()];
  if (waiting_ < effects_.size()) ++waiting_;
  effect.tick = tick;
  effect.offset = std::max(offset, 0.0);
  effect.tau = map_of(tau);
}

void DeadlinePlant::finish_tick() {
  const std::int64_t k = plant_.tick();
  if (safe_) take_safe_torque();
  for (; waiting_ > 0 && effects_[first_].tick <= k; first_ = (first_ + 1) % effects_.size(), --waiting_) {
    if (safe_) continue;
    commanded_ = effects_[first_].tau;
    plant_.take_effect(effects_[first_].offset, span_of(std::as_const(commanded_)));
  }
  plant_.finish_tick();
  if (!safe_) count(newest_ >= k);
}

void DeadlinePlant::count(bool in_time) {
  last_hundred_[static_cast<std::size_t>(counted_++) % last_hundred_.size()] = in_time;
  if (in_time) {
    run_of_misses_ = 0;
    return;
  }
  ++missed_;
  longest_miss_ = std::max(longest_miss_, ++run_of_misses_);
  if (run_of_misses_ > deadline_.max_missed) go_safe("commands missed");
}

double DeadlinePlant::success_last_100() const {
  const auto known = std::min<std::int64_t>(counted_, static_cast<std::int64_t>(last_hundred_.size()));
  if (known == 0) return 1;
  return static_cast<double>(std::count(last_hundred_.begin(), last_hundred_.begin() + known, true)) /
         static_cast<double>(known);
}

void DeadlinePlant::make_safe(const char* cause) {
  if (safe_) return;
  arrivals_.interventions.push_back({.tick = plant_.tick(), .cause = cause});
  go_safe(cause);
}

bool DeadlinePlant::inject(const Fault& fault) {
  auto& kept = arrivals_.interventions;
  if (kept.size() >= kInjected || !plant_.inject(fault)) return false;
  kept.push_back({.tick = plant_.tick(), .fault = fault});
  return true;
}

void DeadlinePlant::go_safe(const char* cause) {
  safe_ = Safe{.tick = plant_.tick(), .cause = cause};
  stand_ = map_of(plant_.psi()).head(stand_.size());
  if (deadline_.safe_state == SafeState::brake) plant_.lock();
}

void DeadlinePlant::take_safe_torque() {
  commanded_.setZero();
  const bool hold = deadline_.safe_state == SafeState::hold;
  const auto n_u = commanded_.size();
  if (hold) commanded_ = deadline_.kp.cwiseProduct(stand_ - map_of(plant_.psi()).head(n_u));
  if (hold || deadline_.safe_state == SafeState::damp)
    commanded_ -= deadline_.kv.cwiseProduct(map_of(plant_.psid()).head(n_u));
  plant_.take_effect(0, span_of(std::as_const(commanded_)));
}

}  // namespace mixloop
