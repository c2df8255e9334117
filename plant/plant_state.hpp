// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dynamics/loop_motion.hpp"
#include "dynamics/procedure/matrix.hpp"
#include "plant/actuators.hpp"
#include "plant/faults.hpp"
#include "plant/sensors.hpp"

namespace mixloop {

/// All that an ideal plant of n coordinates and n_u motors remembers, on any scalar.
template <class T>
struct IdealState {
  std::int64_t tick = 0;
  Vec<T> x;                      ///< psi, psi', n each, and the work that the motors have done, J
  Vec<T> applied;                ///< n_u, what acts: after delay and saturation, N m or N
  std::vector<Vec<T>> commands;  ///< a ring by tick, as long as the delay needs
  double within = 0;             ///< s after the tick's start that is reached
  bool locked = false;           ///< the motors are, for good

  std::size_t n() const { return static_cast<std::size_t>(x.size() / 2); }
  std::span<const T> psi() const { return {x.data(), n()}; }
  std::span<const T> psid() const { return {x.data() + n(), n()}; }
  const T& work() const { return x[x.size() - 1]; }

  bool operator==(const IdealState&) const = default;
};

/// What drives, sensors and faults remember; empty where there are none.
struct HardwareState {
  Vector asked;  ///< n_u, the latest command
  bool was_asked = false;
  Actuators::State actuators;
  Sensors::State sensors;
  Faults::State faults;

  bool operator==(const HardwareState&) const = default;
};

/// All that a plant remembers: a value. Whoever puts one back gets the same bytes from there on.
struct PlantState {
  IdealState<double> motion;  ///< in the partition in use
  HardwareState hardware;
  /// Where closures are solved from (ClosureFollower), as long as the longest of all partitions; empty where
  /// none are.
  std::vector<double> anchor;
  LoopMotion loops;           ///< at the tick; empty where no coordinates are switched
  std::int64_t switches = 0;  ///< of them, until the tick

  bool operator==(const PlantState&) const = default;
};

}  // namespace mixloop
