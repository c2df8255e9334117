// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dynamics/scene/check_physical.hpp"
#include "plant/faults.hpp"

namespace mixloop {
namespace {

using Kind = Fault::Kind;
using Target = Fault::Target;

constexpr double kMostDelayTicks = 10000;

bool changes(const Fault& fault) {
  return fault.target == Target::parameter || fault.target == Target::friction;
}

const char* objection_to_magnitude(const Fault& fault, double rate_hz) {
  const double magnitude = fault.magnitude;
  if (fault.kind == Kind::garbage && magnitude <= 0) return "the magnitude of garbage is not positive";
  if (fault.kind == Kind::slow && magnitude <= 0) return "the time constant is not positive";
  if (fault.kind == Kind::delayed &&
      !(magnitude > 0 && magnitude <= Faults::longest_delay(rate_hz) * (1 + 1e-9)))
    return "the dead time is not within 0 to 1 s and 10000 ticks";
  if (fault.kind == Kind::intermittent && !(magnitude > 0 && magnitude <= 1))
    return "the share of time that it is off is not within 0 to 1";
  return nullptr;
}

/// Says what is not physical before any objection does: it knows more.
void require_physical(const Fault& fault, const FaultGround& ground) {
  const auto index = static_cast<std::size_t>(fault.index);
  if (fault.target != Target::parameter || fault.kind != Kind::changed || index >= ground.values.size() ||
      !may_change(ground.scene, fault.index))
    return;
  auto changed = ground.values;
  changed[index] = fault.magnitude;
  try {
    check_physical(ground.scene, changed);
  } catch (const InputError& error) {
    throw InputError(error.code, {}, "with this value, " + error.message);
  }
}

}  // namespace

double Faults::longest_delay(double rate_hz) { return std::min(kLongestDelay, kMostDelayTicks / rate_hz); }

bool has_magnitude(Kind kind) { return kind != Kind::none && kind != Kind::off && kind != Kind::stuck; }

bool may_change(const Scene& scene, int parameter) {
  const auto uses = [&](const Formula& formula) {
    return std::any_of(formula.nodes.begin(), formula.nodes.end(), [&](const Formula::Node& node) {
      return node.op == Formula::Operator::symbol && node.symbol == Symbols::kParameter0 + parameter;
    });
  };
  for (const auto& coordinate : scene.coordinates)
    if (uses(coordinate.constraint)) return false;
  for (const auto& transform : scene.transforms)
    if (uses(transform.theta) || uses(transform.s) || uses(transform.a) || uses(transform.alpha))
      return false;
  return std::none_of(scene.end_effector.point.begin(), scene.end_effector.point.end(), uses);
}

const char* objection(const Fault& fault, double rate_hz) {
  if (!std::isfinite(fault.magnitude) || !std::isfinite(fault.at) || !std::isfinite(fault.duration))
    return "a number is not finite";
  if (fault.at < 0 || fault.duration < 0) return "a time is negative";
  if (fault.target > Target::friction) return "there is no such target";
  if (fault.target != Target::friction && fault.index < (fault.target == Target::parameter ? 0 : -1))
    return "the index is negative";
  if (!changes(fault)) {
    if (fault.kind > Kind::intermittent)
      return "motors and sensors have no such kind; expected none, off, stuck, garbage, wrong, slow, delayed "
             "or intermittent";
    return objection_to_magnitude(fault, rate_hz);
  }
  if (fault.kind == Kind::none) return nullptr;
  if (fault.kind != Kind::changed)
    return "parameters and friction can only be changed; expected kind changed, or none to heal";
  return fault.target == Target::friction && fault.magnitude < 0 ? "the factor on friction is negative"
                                                                 : nullptr;
}

const char* objection(const Fault& fault, const Scene& scene, double rate_hz) {
  if (const char* reason = objection(fault, rate_hz)) return reason;
  if (fault.target == Target::friction) return nullptr;
  const auto count = fault.target == Target::parameter ? static_cast<int>(scene.parameters.size())
                     : fault.target == Target::sensor  ? scene.n()
                                                       : scene.n_u();
  if (fault.index >= count) return "there is no such motor, sensor or parameter";
  if (fault.target != Target::parameter || fault.kind == Kind::none) return nullptr;
  if (!may_change(scene, fault.index))
    return "the mechanism's geometry depends on the parameter: it can't jump in a run";
  const auto index = static_cast<std::size_t>(fault.index);
  return scene.parameters[index].dimension.same_powers(kMass) && fault.magnitude < 0 ? "the mass is negative"
                                                                                     : nullptr;
}

void require_possible(const Fault& fault, const FaultGround& ground) {
  require_physical(fault, ground);
  if (const char* reason = objection(fault, ground.scene, ground.rate_hz))
    throw InputError("out_of_range", {}, reason);
  if (fault.target == Target::friction && !ground.friction)
    throw InputError("out_of_range", {},
                     "neither the scene nor plant.actuators has friction that could change");
}

}  // namespace mixloop
