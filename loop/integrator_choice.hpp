// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "loop/plant_probe.hpp"

namespace mixloop {

/// What `integrator: auto` came to.
struct IntegratorChoice {
  Method method = Method::rk4;
  int substeps = 1;
  double asked = 0;     ///< local error that a tick may add, as error_size measures it
  double estimate = 0;  ///< the largest that it adds at the ticks looked at
  std::string why;      ///< for people
};

/// What a choice has to serve.
struct ChoiceTask {
  double rate_hz = 1000;
  double local_error = 1e-9;
  bool ideal_drives = true;  ///< methods that take a Jacobian serve
};

/// The cheapest method of fixed cost that keeps `local_error` a tick of 1 / rate: looked at along the path,
/// at up to 48 ticks, with the torque that follows it held over the tick, against DOP853 under error control;
/// the estimate must stay below half of it. A method that gets the plant's own motions about these states
/// wrong (step_fitness.hpp) is left out, whether the path excites them or not. Cost is counted in evaluations
/// and the Jacobian's operations, never by a clock: the same everywhere. Throws InputError("out_of_reach")
/// where none keeps it.
IntegratorChoice choose_integrator(PlantProbe& probe, const Plan& plan, const ChoiceTask& task);

/// What the steps of a tick add at the worst of some poses, as error_size measures it.
struct LocalError {
  double error = 0;
  double t = 0;  ///< s
};
LocalError largest_local_error(PlantProbe& probe, const std::vector<PlantPose>& poses,
                               const IntegratorSettings& steps, const ChoiceTask& task);

/// Poses of the plan, evenly spread over it.
std::vector<PlantPose> poses_on_plan(PlantProbe& probe, const Plan& plan, double rate_hz);

/// Of so many ticks those to look at, ascending, the first one among them.
std::vector<std::int64_t> ticks_to_look_at(std::int64_t ticks);

}  // namespace mixloop
