// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/partitions.hpp"
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
  /// Of a run that switches coordinates.
  struct Switched {
    Switched(const Experiment& experiment, Equations::Options options);

    Partitions dynamics, showing;  ///< what moves, and the swapped psi_i on a slide
    LoopMotion motion;
  };
  void evaluate(Purpose purpose, std::int64_t k, std::span<const double> input, std::span<double> outputs);
  void take_conditions(std::int64_t k);
  void hold_motors(std::int64_t k);
  void show_swapped(std::int64_t k);

  const Recorder& recorder_;
  bool brakes_;  ///< in its safe state the plant's motors are locked
  std::optional<HeldMotors> held_;
  std::shared_ptr<const std::vector<Partition>> partitions_;
  std::optional<Equations::Workspace> dynamics_;
  std::optional<Switched> switched_;  ///< one of the two
  std::int64_t conditions_since_ = -1;
  std::vector<double> hand_, zdd_;
  Truth truth_;
};

}  // namespace mixloop
