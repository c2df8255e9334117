// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>

#include <mixloop/experiment.hpp>

namespace mixloop::v1 {

/// What came of a run, in SI. Numbers that were never measured are NaN, position errors without a path too.
struct Result {
  std::string verdict;                    ///< "held", "missed", "diverged"
  std::vector<std::string> missed;        ///< each bound of `expect` that was missed, in words
  double max_position_error = 0;          ///< m
  double time_of_max_position_error = 0;  ///< s
  double final_position_error = 0;        ///< m, at the last tick
  double rms_position_error = 0;          ///< m
  std::vector<double> max_torque;         ///< n_u, of the commands' magnitudes
  std::optional<double> diverged_at;      ///< s
  std::string trajectory_sha256;  ///< of t, psi, psi', tau of all ticks, as `mixloop simulate` gives it
  std::int64_t ticks = 0;         ///< the last one recorded
  std::vector<double> psi;        ///< n a tick, from tick 0 on
  std::vector<double> psid;       ///< their rates
  std::vector<double> tau;        ///< n_u a tick, as commanded
  /// Where it was asked for or there is no path: the largest |E - E_0 - W| of all ticks over the largest |E|,
  /// E the mechanism's energy, W the motors' work.
  std::optional<double> energy_drift;
};

/// The closed loop in this process: the bytes of `mixloop simulate`. Throws Error.
MIXLOOP_API Result simulate(const Experiment& experiment);

/// The same with a control law of one's own, called once a tick (with `control: continuous` at each stage of
/// the integrator) with what is measured and desired; it writes tau (n_u). What it throws comes through.
MIXLOOP_API Result simulate(
    const Experiment& experiment,
    const std::function<void(const State& measured, const Reference& desired, std::span<double> tau)>& law);

}  // namespace mixloop::v1
