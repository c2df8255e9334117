// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "dynamics/scene/coordinate_values.hpp"
#include "plant/faults.hpp"

namespace mixloop {
namespace {

using Kind = Fault::Kind;
using Target = Fault::Target;

std::string whose(const Fault& fault, const Scene& scene) {
  const bool motor = fault.target == Target::motor;
  const auto coordinates = motor ? scene.motors() : std::span<const Scene::Independent>(scene.independent);
  const char* noun = motor ? "motor" : "sensor";
  if (fault.index < 0) return fmt::format("every {}", noun);
  const auto index = static_cast<std::size_t>(fault.index);
  return index < coordinates.size() ? fmt::format("{} {}", noun, coordinates[index].name)
                                    : fmt::format("{} {}", noun, index + 1);
}

/// Of all of them it may be in several units, and in none is said.
std::string unit_of(const Fault& fault, const Scene& scene) {
  const auto index = static_cast<std::size_t>(fault.index);
  if (fault.index < 0 || index >= scene.independent.size()) return "";
  const bool linear = scene.independent[index].linear;
  return std::string(" ") + (fault.target == Target::motor ? torque_unit(linear) : position_unit(linear));
}

std::string becomes(const Fault& fault, const Scene& scene) {
  const double x = fault.magnitude;
  switch (fault.kind) {
    case Kind::none:
      return "is well again";
    case Kind::garbage:
      return fmt::format("gives garbage within +-{:g}{}", x, unit_of(fault, scene));
    case Kind::wrong:
      return fmt::format("is off by {:g}{}", x, unit_of(fault, scene));
    case Kind::slow:
      return fmt::format("lags with a time constant of {:g} s", x);
    case Kind::delayed:
      return fmt::format("is late by {:g} s", x);
    case Kind::intermittent:
      return fmt::format("is off in {:g} % of the ticks", 100 * x);
    default:
      return fmt::format("is {}", Fault::kKinds[static_cast<std::size_t>(fault.kind)]);
  }
}

std::string event(const Fault& fault, const Scene& scene) {
  if (fault.target == Target::friction)
    return fault.kind == Kind::none ? "friction is as it was"
                                    : fmt::format("friction is {:g} times as large", fault.magnitude);
  if (fault.target != Target::parameter) return whose(fault, scene) + " " + becomes(fault, scene);
  const auto index = static_cast<std::size_t>(fault.index);
  const std::string name =
      index < scene.parameters.size() ? scene.parameters[index].name : fmt::format("{}", index + 1);
  return fault.kind == Kind::none ? fmt::format("parameter {} is as it was", name)
                                  : fmt::format("parameter {} is {:g} (SI)", name, fault.magnitude);
}

}  // namespace

std::string to_string(const Fault& fault, const Scene& scene) {
  return fmt::format("{} from {:g} s on{}", event(fault, scene), fault.at,
                     fault.duration > 0 ? fmt::format(", for {:g} s", fault.duration) : "");
}

}  // namespace mixloop
