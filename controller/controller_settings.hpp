// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "controller/safety_settings.hpp"
#include "controller/torque_course.hpp"
#include "dynamics/procedure/matrix.hpp"
#include "dynamics/scene/scene.hpp"
#include "notation/document.hpp"
#include "planner/reference.hpp"

namespace mixloop {

enum class Law {
  pd,               ///< tau = Kp e + Kv e'
  pd_gravity,       ///< + h(Psi, 0): gravity and static loads
  pd_feedforward,   ///< + M(Psi) Psi''_d, the paper's (33)
  computed_torque,  ///< + M(Psi) Psi''_d + h(Psi, Psi')
  torque,           ///< tau(t), whatever the state
  state_feedback,   ///< tau = tau_0 - K (x - x_0), x = (Psi, Psi') of all independent coordinates
};

/// Whether a law has the gains Kp and Kv, and follows references by them; without a path only the others do.
constexpr bool has_gains(Law law) { return law != Law::torque && law != Law::state_feedback; }

/// Where the model is evaluated: at the measured state, or at the desired one.
enum class FeedforwardAt { measured, desired };

struct ControllerSettings {
  Law law = Law::pd_feedforward;
  FeedforwardAt feedforward_at = FeedforwardAt::measured;
  Vector kp, kv;        ///< n_u: the diagonals of Kp (N m/rad) and Kv (N m s/rad); zeros of laws without
  TorqueCourse course;  ///< of the law torque
  Matrix gain;          ///< K, n_u x 2n, of state_feedback: N m/rad, then N m s/rad
  Vector about_psi, about_psid;  ///< n: x_0 of state_feedback; with a path, the free coordinates' part
  Vector about_torque;           ///< n_u: its tau_0
  SafetySettings safety;
};

/// Reads `{law, kp, kv, feedforward_at, torque, file, gain, about, safety}`, each where its law has it; the
/// keys `parameters` and `scene` belong to the experiment. A file's path counts from `folder`.
ControllerSettings read_controller_settings(const NodePtr& node, const Scene& scene,
                                            const std::filesystem::path& folder = {});

/// Where the law wants all independent coordinates (n) while the motors' reference is this: the free ones at
/// rest at home, or where its `about` has them.
PsiMotion wanted_state(const ControllerSettings& settings, const Scene& scene, const Reference& desired);

}  // namespace mixloop
