// SPDX-License-Identifier: MIT
// What goes into a kernel of closed loops and comes out. This text also goes into every kernel.
#pragma once

namespace mixloop_loop {

/// What all runs have in common.
struct Common {
  long long ticks, start_tick;
  double rate;         // Hz
  double tick_length;  // s
  int substeps;
  int feedforward, bias, at_desired,
      at_rest;            // what the law takes: M psidd_d, h; at the reference; with psid = 0
  int axes[3];            // which of x, y, z count
  int differentiated;     // velocities are measured as differences
  int runs;               // beside each other in memory
  double settled_within;  // m; below 0: not asked for
  const double*
      references;  // of each tick psi, psid, psidd (n_u each), place, velocity, acceleration (3 each)
};

/// What each has of its own: number i of run r stands at [i * runs + r].
struct Each {
  const double *psi0, *kp, *kv, *torque_limit, *error_limit;
  const double *delay_ticks, *delay_rest;
  const double *plant_constants, *mass_constants, *bias_constants, *hand_constants;
  // Of what isn't ideal, where there is any.
  const double* drives;          // kDriveNumbers * n_u
  const double* sensors;         // kSensorNumbers * n
  const double* sensor_delay;    // n, ticks
  const double* velocity_share;  // of the new value in the low-pass
  const unsigned long long* seeds;
};

[[maybe_unused]] constexpr int kDriveNumbers =
    7;  // rate limit, lag, ripple, its periods per rad, viscous, Coulomb's, smooth
[[maybe_unused]] constexpr int kSensorNumbers = 3;  // resolution, noise, bias

/// What became of it, laid out in the same way.
struct Told {
  double* ticks_recorded;  // the run diverged at that tick where it is less than all
  double *most_error, *most_error_tick, *last_error, *squares, *errors, *settled_tick;
  double* most_torque;  // n_u
  double* trajectory;   // psi, psid (n), tau (n_u) of each tick; or null
  double* ring;         // room for commands: ring_ticks * n_u
  int ring_ticks;
  double* sensor_ring;  // and for readings: sensor_ticks * 2 n, where more than one tick's
  int sensor_ticks;
};

}  // namespace mixloop_loop
