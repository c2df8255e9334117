// SPDX-License-Identifier: MIT
#include "loop/free_motion.hpp"

#include <fmt/format.h>

#include "loop/experiment_keys.hpp"
#include "planner/itinerary.hpp"

namespace mixloop {

void refuse_limits(const Mapping& limits) {
  for (const Key& key : limit_keys().all)
    if (const NodePtr limit = limits.find(key.name))
      throw InputError(
          "out_of_range", limit->place,
          fmt::format("limits.{} is of a path, and the experiment has none; expected it beside a "
                      "path alone",
                      key.name));
}

void check_motion(const Experiment& experiment, const NodePtr& controller, const NodePtr& plant) {
  const auto refuse = [](const NodePtr& mapping, const char* key, const std::string& why) {
    throw InputError("out_of_range", find_entry(*mapping, key)->place, why);
  };
  const ControllerSettings& settings = experiment.controller;
  if (experiment.has_path()) {
    if (experiment.plant.partitions)
      refuse(plant, "near_singular",
             "a path is planned, and followed, in the declared coordinates, which near_singular: switch "
             "leaves; expected it beside a duration alone, or near_singular: stop");
    if (!experiment.plant.initial_psid.empty())
      refuse(plant, "initial_rates",
             "a path begins at rest, and so does the move to its start; expected initial_rates beside a "
             "duration alone");
    const NodePtr about = find_entry(*controller, "about");
    for (const char* key : {"psi", "psid"})
      if (about && experiment.scene->n() == experiment.scene->n_u() && find_entry(*about, key))
        refuse(about, key,
               "with a path the motors' state is fed back about its reference, and there are no other "
               "coordinates; expected no about." +
                   std::string(key));
    return;
  }
  if (has_gains(settings.law))
    refuse(controller, "law",
           fmt::format("the law {} follows a path, and the experiment has none; expected torque or "
                       "state_feedback, or a path",
                       describe(*find_entry(*controller, "law"))));
  if (!settings.safety.start_tolerance.empty())
    refuse(find_entry(*controller, "safety"), "start_tolerance",
           "start_tolerance is of a path's start, and the experiment has no path; expected it beside a path "
           "alone");
  if (experiment.plant.automatic)
    refuse(plant, "integrator",
           "integrator: auto looks along a path, and the experiment has none; expected a named integrator");
}

void settle_safe_state(const Mapping& root, Experiment& experiment) {
  experiment.deadline.kp = experiment.controller.kp;
  experiment.deadline.kv = experiment.controller.kv;
  const NodePtr real_time = root.find("real_time");
  const NodePtr state = real_time ? find_entry(*real_time, "safe_state") : nullptr;
  const bool moves_on = experiment.scene->n() > experiment.scene->n_u();
  if (experiment.deadline.safe_state == SafeState::brake && experiment.plant.partitions && moves_on)
    throw InputError(
        "out_of_range", state->place,
        "the safe state brake holds the motors while free coordinates move on, and that is known in "
        "the declared coordinates alone, which near_singular: switch leaves; expected zero_torque, or "
        "near_singular: stop");
  if (has_gains(experiment.controller.law)) return;
  if (!state) {
    experiment.deadline.safe_state = SafeState::zero_torque;
    return;
  }
  const SafeState asked = experiment.deadline.safe_state;
  if (asked == SafeState::hold || asked == SafeState::damp)
    throw InputError("out_of_range", state->place,
                     fmt::format("the safe state {} takes kp and kv, which the controller's law has not; "
                                 "expected zero_torque or brake",
                                 name_of(asked)));
}

std::span<const double> start_of(const Experiment& experiment) {
  const auto& initial = experiment.plant.initial_psi;
  return initial.empty() ? std::span<const double>(experiment.scene->home) : initial;
}

Plan plan_without_path(const Experiment& experiment) {
  const std::int64_t ticks =
      ticks_of(*experiment.duration, experiment.rate_hz, experiment.path.place, "the duration");
  const Eigen::Index n_u = experiment.scene->n_u();
  PsiMotion motors{map_of(start_of(experiment)).head(n_u), Vector::Zero(n_u), Vector::Zero(n_u)};
  if (experiment.controller.law == Law::state_feedback) {
    motors.psi = experiment.controller.about_psi.head(n_u);
    motors.psid = experiment.controller.about_psid.head(n_u);
  }
  return Plan::without_path(motors, ticks);
}

}  // namespace mixloop
