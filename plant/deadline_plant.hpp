// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "plant/arrivals.hpp"
#include "plant/deadline_settings.hpp"
#include "plant/plant.hpp"

namespace mixloop {

/// What a plant under commands with a deadline remembers beside its own state.
struct DeadlineState {
  struct Effect {
    std::int64_t tick = 0;
    double offset = 0;  ///< s
    Vector tau;
    bool operator==(const Effect&) const = default;
  };
  struct Safe {
    std::int64_t tick;
    const char* cause;
    bool operator==(const Safe&) const = default;
  };

  std::int64_t newest = -1;     ///< the newest command that arrived
  std::vector<Effect> effects;  ///< a ring of those that are still to act
  std::size_t first = 0, waiting = 0;
  Vector commanded, stand;  ///< n_u; stand: the motors' psi where the safe state began
  std::optional<Safe> safe;
  Arrivals arrivals;
  std::int64_t missed = 0, longest_miss = 0, run_of_misses = 0, counted = 0;
  std::vector<bool> last_hundred;  ///< ticks, by counted: whether their command came in time

  bool operator==(const DeadlineState&) const = default;
};

/// The plant under commands with a deadline: each acts when it arrives (`command_delay` later, where there is
/// one), one that misses its tick is counted, too many in a row bring the safe state, which only a new plant
/// leaves. A pure function of the arrivals, so that `simulate --ages` goes through the same bytes. It knows
/// ticks and offsets within them, no clock. Nothing allocates after construction.
class DeadlinePlant {
 public:
  /// `ticks`: as many arrivals are kept, beside a few.
  DeadlinePlant(Plant plant, const PlantSettings& settings, DeadlineSettings deadline, double rate_hz,
                std::int64_t ticks);

  /// All that it remembers, the plant apart.
  const DeadlineState& state() const { return state_; }
  /// Goes on from states of this plant.
  void put_back(const DeadlineState& state, const PlantState& plant);

  Plant& plant() { return plant_; }
  const Plant& plant() const { return plant_; }

  /// A command arrives, in the tick in hand whatever `arrival` says. Older ones than the newest one are no
  /// news. COMMAND(0) acts at once, whatever the delay: the robot starts held.
  void command(Arrival arrival, std::span<const double> tau);

  /// Goes on to the next tick.
  void finish_tick();

  /// Brings the safe state, from the tick in hand on. `cause` must outlive this.
  void make_safe(const char* cause);
  /// Why a fault that could be can't be taken now, `before` having come in this tick; null where it can.
  const char* no_room_for(const Fault& fault, std::span<const Fault> before) const;
  /// Plant::inject, kept among the arrivals; false also where there is no room. What it changes in the tick
  /// in hand it changes from its start.
  bool inject(const Fault& fault);
  static constexpr std::size_t kInjected = 1000;  ///< so many a run, but for what heals
  const std::optional<DeadlineState::Safe>& safe() const { return state_.safe; }

  /// The command in effect at the end of the last tick, before limits; in the safe state, what stands for it.
  std::span<const double> commanded() const { return span_of(state_.commanded); }

  std::int64_t missed() const { return state_.missed; }  ///< ticks whose command came late or never
  std::int64_t longest_miss() const { return state_.longest_miss; }  ///< the longest run of them
  double success_last_100() const;  ///< of the last 100 ticks, as far as there are
  const Arrivals& arrivals() const { return state_.arrivals; }

 private:
  void queue(std::int64_t tick, double offset, std::span<const double> tau);
  void count(bool in_time);
  void go_safe(const char* cause);
  void take_safe_torque();

  Plant plant_;
  DeadlineSettings deadline_;
  double tick_length_, delay_;
  DeadlineState state_;
};

}  // namespace mixloop
