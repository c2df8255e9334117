// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "plant/chance.hpp"
#include "plant/faults.hpp"

namespace mixloop {

/// What lies between the independent coordinates and what is said of them. Vectors have a value for each, in
/// rad or m; empty: not so.
struct SensorSettings {
  std::vector<double> resolution;  ///< readings are whole multiples of it, the nearest
  std::vector<double> noise;       ///< standard deviation of a normal one, before rounding
  std::vector<double> bias;
  std::vector<std::int64_t> delay;  ///< ticks
  std::vector<double> drop;         ///< probability that a tick's reading isn't delivered: the last one stays
  bool differentiated = false;      ///< the velocity is the position's difference over a tick
  double velocity_filter = 0;       ///< Hz, of a first-order low-pass after it; 0: none
  std::vector<int> unmeasured;      ///< free coordinates without a sensor, in the scene's order

  bool any() const {
    return !resolution.empty() || !noise.empty() || !bias.empty() || !delay.empty() || !drop.empty() ||
           differentiated;
  }
  bool random() const { return !noise.empty() || !drop.empty(); }
  /// Which of n independent coordinates are measured.
  std::vector<int> measured(std::size_t n) const;
};

/// Reads `{free, resolution, noise, bias, delay, drop, velocity: measured | differentiated,
/// velocity_filter}`.
SensorSettings read_sensor_settings(const NodePtr& node, const Scene& scene, double rate_hz);

/// The sensors: of psi a reading, psi + bias + noise rounded to the resolution and through the sensor's
/// fault; of psi' the true one, or the reading's difference over a tick, low-passed; both `delay` ticks old;
/// the last ones again where they aren't delivered. Nothing allocates but state().
class Sensors {
 public:
  /// What the sensors remember.
  struct State {
    struct Channel {
      double before = 0, filtered = 0;            ///< the last tick's reading, the low-passed velocity
      std::vector<double> positions, velocities;  ///< rings by tick
      double position = 0, velocity = 0;          ///< as delivered last
      bool operator==(const Channel&) const = default;
    };
    std::vector<Channel> channels;
    std::int64_t tick = -1;  ///< the last one measured
    bool stale = false;
    bool operator==(const State&) const = default;
  };

  Sensors(const SensorSettings& settings, std::uint64_t seed, std::size_t n, double rate_hz);

  /// A measured coordinate's; what it doesn't have is 0.
  struct Channel {
    std::size_t coordinate;
    double resolution, noise, bias, drop;
    std::size_t delay;
  };
  const std::vector<Channel>& channels() const { return channels_; }
  double velocity_share() const { return share_; }

  /// Before any measurement.
  State state() const;

  /// Of psi and psid (n) the measured ones, at each tick, in order (the same one again gives the same); true
  /// where a reading is stale. The first tick's are always delivered, and stand for what is older. `faults`
  /// may be null.
  bool measure(State& state, std::int64_t tick, std::span<const double> psi, std::span<const double> psid,
               Faults::State* faults, std::span<double> psi_out, std::span<double> psid_out) const;

 private:
  /// True where it isn't delivered.
  bool read(State& state, std::size_t i, std::int64_t tick, double psi, double psid,
            Faults::State* faults) const;

  Chance chance_;
  double rate_hz_;
  bool differentiated_;
  double share_;  ///< of the new value in the low-pass
  std::vector<Channel> channels_;
};

}  // namespace mixloop
