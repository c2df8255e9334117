// SPDX-License-Identifier: MIT
#pragma once

#include "controller/safety_settings.hpp"
#include "dynamics/procedure/matrix.hpp"
#include "dynamics/scene/scene.hpp"
#include "notation/document.hpp"

namespace mixloop {

enum class Law {
  kPd,              ///< tau = Kp e + Kv e'
  kPdGravity,       ///< + h(Psi, 0): gravity and static loads
  kPdFeedforward,   ///< + M(Psi) Psi''_d, the paper's (33)
  kComputedTorque,  ///< + M(Psi) Psi''_d + h(Psi, Psi')
};

/// Where the model is evaluated: at the measured state, or at the desired one.
enum class FeedforwardAt { kMeasured, kDesired };

struct ControllerSettings {
  Law law = Law::kPdFeedforward;
  FeedforwardAt feedforward_at = FeedforwardAt::kMeasured;
  Vector kp, kv;  ///< n: the diagonals of Kp (N m/rad) and Kv (N m s/rad)
  SafetySettings safety;
};

/// Reads `{law, kp, kv, feedforward_at, safety}`; the keys `parameters` and `scene` belong to the experiment.
ControllerSettings read_controller_settings(const NodePtr& node, const Scene& scene);

}  // namespace mixloop
