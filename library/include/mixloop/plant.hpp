// SPDX-License-Identifier: MIT
#pragma once

#include <mixloop/experiment.hpp>

namespace mixloop::v1 {

/// An experiment's simulated hardware, tick by tick: mechanism, drives, sensors, scheduled faults. All that
/// it remembers is its value: whoever goes on with a copy gets the same bytes. Nothing allocates but
/// construction and copying.
class MIXLOOP_API Plant {
 public:
  /// At tick 0, where the experiment begins, at rest unless it has initial_rates. Throws Error, also for
  /// `plant.control: continuous`, which has no ticks to command ("out_of_range").
  Plant(const Experiment& experiment, const Plan& plan);
  Plant(const Plant&);               ///< goes on from the same state
  Plant(Plant&&) noexcept;           ///< the other may only be assigned to or destroyed
  Plant& operator=(Plant) noexcept;  ///< copies or moves
  ~Plant();

  std::int64_t tick() const;                ///< k, from 0
  State state() const;                      ///< the true one; a view until the plant goes on
  State measured();                         ///< what the sensors say at this tick; a view until then
  std::span<const double> applied() const;  ///< n_u, N m or N: what acts, after delay, limits and drives
  double work() const;                      ///< J, that the motors have done

  /// Takes the tick's command (n_u, N m or N), which is held, and goes on to the next tick. Throws
  /// Error("wrong_size").
  void advance(std::span<const double> tau);

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace mixloop::v1
