// SPDX-License-Identifier: MIT
#include "plant/faults.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mixloop {
namespace {

using Kind = Fault::Kind;
using Target = Fault::Target;

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kLatest = std::int64_t{1} << 53;  // whole numbers are exact up to here

}  // namespace

bool FaultSettings::random() const {
  return std::any_of(scheduled.begin(), scheduled.end(), [](const Fault& fault) {
    return fault.kind == Kind::garbage || fault.kind == Kind::intermittent;
  });
}

bool FaultSettings::change_friction() const {
  return injected || std::any_of(scheduled.begin(), scheduled.end(),
                                 [](const Fault& fault) { return fault.target == Target::friction; });
}

std::int64_t first_tick_at(double time, double rate_hz) {
  const double ticks = time * rate_hz;
  return ticks < static_cast<double>(kLatest)
             ? static_cast<std::int64_t>(std::ceil(ticks - 1e-9 * std::max(1.0, ticks)))
             : kLatest;
}

FaultFilter::FaultFilter(Chance chance, std::size_t channel, Draw draw, double rate_hz)
    : chance_(chance),
      channel_(channel),
      draw_(draw),
      rate_hz_(rate_hz),
      ring_(static_cast<std::size_t>(std::ceil(Faults::longest_delay(rate_hz) * rate_hz)) + 1) {}

void FaultFilter::start(Kind kind, double magnitude) {
  kind_ = kind;
  magnitude_ = magnitude;
  begun_ = false;
  if (kind == Kind::delayed) {
    delay_ = std::clamp<std::int64_t>(std::llround(magnitude * rate_hz_), 1,
                                      static_cast<std::int64_t>(ring_.size()) - 1);
    filled_ = 0;
  }
}

double FaultFilter::pass(std::int64_t tick, double value) {
  const bool first_ever = tick_ < 0;
  if (tick != tick_) {
    before_ = first_ever ? value : out_;
    tick_ = tick;
    ++filled_;
  }
  if (!begun_) {  // what it keeps or comes from is the last value before
    held_ = before_;
    begun_ = true;
    filled_ = 1;
  }
  return out_ = filtered(value);
}

double FaultFilter::filtered(double value) {
  switch (kind_) {
    case Kind::off:
      return 0;
    case Kind::stuck:
      return held_;
    case Kind::garbage:
      return magnitude_ * (2 * chance_.uniform(tick_, channel_, draw_) - 1);
    case Kind::wrong:
      return value + magnitude_;
    case Kind::slow:  // T y' = u - y over a tick, u what it is now
      return before_ - std::expm1(-1 / (magnitude_ * rate_hz_)) * (value - before_);
    case Kind::delayed: {
      const auto size = static_cast<std::int64_t>(ring_.size());
      ring_[static_cast<std::size_t>(tick_ % size)] = value;
      return filled_ <= delay_ ? held_ : ring_[static_cast<std::size_t>((tick_ - delay_) % size)];
    }
    case Kind::intermittent:
      return chance_.uniform(tick_, channel_, draw_) < magnitude_ ? 0 : value;
    case Kind::none:
    case Kind::changed:
      break;
  }
  return value;
}

Faults::Faults(const FaultSettings& settings, std::uint64_t seed, const Scene& scene, double rate_hz,
               std::vector<double> values)
    : scheduled_(settings.scheduled),
      chance_(seed),
      rate_hz_(rate_hz),
      n_(scene.independent.size()),
      n_u_(scene.motors().size()),
      normal_(std::move(values)) {}

Faults::State Faults::state() const {
  State state{.until = std::vector<std::int64_t>(n_u_ + n_ + normal_.size() + 1, kNever),
              .parameters = normal_};
  for (std::size_t i = 0; i < n_u_; ++i) state.motors.emplace_back(chance_, i, Draw::motor_fault, rate_hz_);
  for (std::size_t i = 0; i < n_; ++i) {
    state.positions.emplace_back(chance_, i, Draw::position_fault, rate_hz_);
    state.velocities.emplace_back(chance_, i, Draw::velocity_fault, rate_hz_);
  }
  state.waiting.reserve(scheduled_.size() + kWaiting + 1);
  for (const Fault& fault : scheduled_) queue(state, fault, 0);
  return state;
}

void Faults::queue(State& state, const Fault& fault, std::int64_t earliest) const {
  const State::Scheduled next{std::max(tick_at(fault.at), earliest), fault};
  state.waiting.insert(std::upper_bound(state.waiting.begin(), state.waiting.end(), next,
                                        [](const auto& a, const auto& b) { return a.tick < b.tick; }),
                       next);
}

bool Faults::inject(State& state, const Fault& fault, const Scene& scene, std::int64_t tick) const {
  if (objection(fault, scene, rate_hz_) || (full(state) && !heals_at_once(fault, tick))) return false;
  queue(state, fault, tick);
  begin(state, tick);
  return true;
}

void Faults::begin(State& state, std::int64_t tick) const {
  bool changed = false;
  for (std::size_t slot = 0; slot < state.until.size(); ++slot)
    if (state.until[slot] <= tick) changed = start(state, healing(slot), kNever) || changed;
  auto& waiting = state.waiting;
  std::size_t due = 0;
  for (; due < waiting.size() && waiting[due].tick <= tick; ++due) {
    const Fault& fault = waiting[due].fault;
    const double from = std::max(fault.at, static_cast<double>(tick) / rate_hz_);
    changed = start(state, fault, fault.duration > 0 ? tick_at(from + fault.duration) : kNever) || changed;
  }
  waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(due));
  if (changed) state.changed_at = tick;
  state.active = any_active(state);
}

Fault Faults::healing(std::size_t slot) const {
  const auto index = [](std::size_t i) { return static_cast<int>(i); };
  if (slot < n_u_) return {.target = Target::motor, .index = index(slot)};
  if (slot < n_u_ + n_) return {.target = Target::sensor, .index = index(slot - n_u_)};
  if (slot < n_u_ + n_ + normal_.size())
    return {.target = Target::parameter, .index = index(slot - n_u_ - n_)};
  return {.target = Target::friction};
}

bool Faults::start(State& state, const Fault& fault, std::int64_t until) const {
  const bool heals = fault.kind == Kind::none;
  if (fault.target == Target::friction) {
    state.friction = heals ? 1 : fault.magnitude;
    state.until.back() = until;
    return true;
  }
  if (fault.target == Target::parameter) {
    const auto i = static_cast<std::size_t>(fault.index);
    state.parameters[i] = heals ? normal_[i] : fault.magnitude;
    state.until[n_u_ + n_ + i] = until;
    return true;
  }
  const bool motors = fault.target == Target::motor;
  for (std::size_t i = 0; i < (motors ? n_u_ : n_); ++i) {
    if (fault.index >= 0 && static_cast<std::size_t>(fault.index) != i) continue;
    if (motors) {
      state.motors[i].start(fault.kind, fault.magnitude);
      state.until[i] = until;
      continue;
    }
    state.positions[i].start(fault.kind, fault.magnitude);
    // Who counts from a wrong zero has the right velocity.
    state.velocities[i].start(fault.kind == Kind::wrong ? Kind::none : fault.kind, fault.magnitude);
    state.until[n_u_ + i] = until;
  }
  return false;
}

bool Faults::is_wrong(const State& state, const Fault& fault) const {
  const auto among = [&fault](const auto& all, const auto& wrong) {
    for (std::size_t i = 0; i < all.size(); ++i)
      if ((fault.index < 0 || static_cast<std::size_t>(fault.index) == i) && wrong(i)) return true;
    return false;
  };
  switch (fault.target) {
    case Target::motor:
      return among(state.motors, [&](std::size_t i) { return state.motors[i].active(); });
    case Target::sensor:
      return among(state.positions, [&](std::size_t i) { return state.positions[i].active(); });
    case Target::parameter:
      return among(normal_, [&](std::size_t i) { return state.parameters[i] != normal_[i]; });
    case Target::friction:
      break;
  }
  return state.friction != 1;
}

bool Faults::any_active(const State& state) const {
  const auto active = [](const FaultFilter& filter) { return filter.active(); };
  return state.friction != 1 || state.parameters != normal_ ||
         std::any_of(state.motors.begin(), state.motors.end(), active) ||
         std::any_of(state.positions.begin(), state.positions.end(), active);
}

}  // namespace mixloop
