// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "loop/plant_probe.hpp"

namespace mixloop {

/// Steps a tick that are tried at most.
inline constexpr int kMostSubsteps = 256;

/// A plant linearised about one of its states: x' = A x, 2n x 2n, at a time.
struct LinearPlant {
  double t = 0;  ///< s
  Matrix A;
};
std::vector<LinearPlant> linearised(PlantProbe& probe, const std::vector<PlantPose>& poses);

/// What steps are to follow: ticks of so many seconds, so many of them, pieces a tick.
struct StepTask {
  double tick = 1e-3;        ///< s
  std::int64_t ticks = 1;    ///< of the run
  bool ideal_drives = true;  ///< methods that take a Jacobian serve
};

/// A motion of the plant's own that a method's steps get wrong.
struct Misfit {
  double t = 0;                      ///< s: of the state
  std::complex<double> pole;         ///< 1/s: of the plant there
  std::complex<double> step, truth;  ///< what becomes of that motion in a tick, by the steps and in truth
  double error = 0;                  ///< the largest within the run, of the amplitude that it starts with
  double tick_error =
      0;  ///< that a tick adds to motions of 1 rad or m about that state, as error_size measures it

  /// Whether it grows by the steps, and more than in truth.
  bool grows() const;
};

/// What may be got wrong of a motion within the run, of its amplitude, and in a tick, as `tick_error`.
struct MotionTolerance {
  double run = 0.05;
  double tick = HUGE_VAL;
};

/// The worst motion of the plant's own that these steps get wrong by more than `tolerance`, whether it grows
/// where it shouldn't, dies away or falls out of step; nothing where they follow all of them, or choose their
/// length by themselves. What is compared are the eigenvalues of the method's map of a tick and of e^(A T).
std::optional<Misfit> misfit(const IntegratorSettings& steps, const StepTask& task,
                             const std::vector<LinearPlant>& plants, const MotionTolerance& tolerance = {});

/// Evaluations of the forward dynamics a tick, `jacobian_cost` of them for a Jacobian.
double cost_of(const IntegratorSettings& steps, double jacobian_cost);

/// What is too coarse, and what serves instead.
std::string describe(const Misfit& misfit, const IntegratorSettings& steps, const StepTask& task,
                     const std::vector<LinearPlant>& plants);

}  // namespace mixloop
