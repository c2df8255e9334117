// SPDX-License-Identifier: MIT
#pragma once

#include "plant/plant.hpp"

namespace mixloop {

/// What a controller gets to see of a plant at a tick. Copies nothing where the sensors are exact.
class MeasuredState {
 public:
  explicit MeasuredState(const Plant& plant)
      : exact_(plant.measures_exactly()), psi_(map_of(plant.psi())), psid_(psi_) {}

  /// At every tick, once.
  void take(Plant& plant) {
    if (!exact_) stale_ = plant.measure(span_of(psi_), span_of(psid_));
    seen_psi_ = exact_ ? plant.psi() : span_of(std::as_const(psi_));
    seen_psid_ = exact_ ? plant.psid() : span_of(std::as_const(psid_));
  }

  std::span<const double> psi() const { return seen_psi_; }
  std::span<const double> psid() const { return seen_psid_; }
  bool stale() const { return stale_; }

 private:
  bool exact_, stale_ = false;
  Vector psi_, psid_;
  std::span<const double> seen_psi_, seen_psid_;
};

}  // namespace mixloop
