// SPDX-License-Identifier: MIT
#pragma once

#include "loop/recorder.hpp"

namespace mixloop {

/// What the plant knows of a recorded tick beside its state, under the torque in effect from it on.
struct Truth {
  std::vector<double> psidd;                                  ///< n
  Eigen::Vector3d position, velocity, acceleration;           ///< of the end effector, inertial frame
  double kinetic_energy = 0, potential_energy = 0, work = 0;  ///< J
};

/// Works out the truth of recorded ticks. Nothing allocates after construction.
class TruthReader {
 public:
  TruthReader(const Experiment& experiment, const Recorder& recorder);

  /// Of a recorded tick, its command known; valid until the next call.
  const Truth& at(std::int64_t k);

 private:
  const Recorder& recorder_;
  Equations::Workspace dynamics_;
  std::int64_t conditions_since_ = -1;
  std::vector<double> hand_;
  Truth truth_;
};

}  // namespace mixloop
