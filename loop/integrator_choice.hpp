// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dynamics/scene/scene.hpp"
#include "integrators/method.hpp"
#include "planner/plan.hpp"

namespace mixloop {

/// What `integrator: auto` came to.
struct IntegratorChoice {
  Method method = Method::rk4;
  int substeps = 1;
  double asked = 0;     ///< local error that a tick may add, as error_size measures it
  double estimate = 0;  ///< the largest that it adds at the ticks looked at
  std::string why;      ///< for people
};

/// The cheapest method of fixed cost that keeps `local_error` a tick of 1 / rate: looked at along the path,
/// at up to 48 ticks, with the torque that follows it held over the tick, against DOP853 under error control;
/// the estimate must stay below half of it. A method past its stability limit, by the plant's linearisation
/// there, is left out. Cost is counted in evaluations and the Jacobian's operations, never by a clock: the
/// same everywhere. Throws InputError("out_of_reach") where none keeps it. Methods with a Jacobian only where
/// `jacobian`.
IntegratorChoice choose_integrator(const std::shared_ptr<const Scene>& scene,
                                   const std::vector<double>& parameters, const Plan& plan, double rate_hz,
                                   double local_error, bool jacobian = true);

}  // namespace mixloop
