// SPDX-License-Identifier: MIT
#pragma once

#include "controller/safety_settings.hpp"
#include "dynamics/procedure/matrix.hpp"
#include "dynamics/scene/scene.hpp"
#include "notation/document.hpp"

namespace mixloop {

enum class Law {
  pd,               ///< tau = Kp e + Kv e'
  pd_gravity,       ///< + h(Psi, 0): gravity and static loads
  pd_feedforward,   ///< + M(Psi) Psi''_d, the paper's (33)
  computed_torque,  ///< + M(Psi) Psi''_d + h(Psi, Psi')
};

/// Where the model is evaluated: at the measured state, or at the desired one.
enum class FeedforwardAt { measured, desired };

struct ControllerSettings {
  Law law = Law::pd_feedforward;
  FeedforwardAt feedforward_at = FeedforwardAt::measured;
  Vector kp, kv;  ///< n_u: the diagonals of Kp (N m/rad) and Kv (N m s/rad)
  SafetySettings safety;
};

/// Reads `{law, kp, kv, feedforward_at, safety}`; the keys `parameters` and `scene` belong to the experiment.
ControllerSettings read_controller_settings(const NodePtr& node, const Scene& scene);

}  // namespace mixloop
