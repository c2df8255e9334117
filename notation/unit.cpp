// SPDX-License-Identifier: MIT
#include "notation/unit.hpp"

#include <array>
#include <numbers>

namespace mixloop {
namespace {

struct NamedUnit {
  const char* name;
  Unit unit;
};

constexpr double kPi = std::numbers::pi;
constexpr Dimension kPower{4, 2, -6, false};

constexpr std::array kUnits = {
    NamedUnit{"m", {1, kLength}},
    NamedUnit{"cm", {1e-2, kLength}},
    NamedUnit{"mm", {1e-3, kLength}},
    NamedUnit{"um", {1e-6, kLength}},
    NamedUnit{"km", {1e3, kLength}},
    NamedUnit{"kg", {1, kMass}},
    NamedUnit{"s", {1, kTime}},
    NamedUnit{"ms", {1e-3, kTime}},
    NamedUnit{"us", {1e-6, kTime}},
    NamedUnit{"ns", {1e-9, kTime}},
    NamedUnit{"min", {60, kTime}},
    NamedUnit{"Hz", {1, kFrequency}},
    NamedUnit{"kHz", {1e3, kFrequency}},
    NamedUnit{"rad", {1, kPure}},
    NamedUnit{"deg", {kPi / 180, kPure}},
    NamedUnit{"rev", {2 * kPi, kPure}},
    NamedUnit{"rpm", {kPi / 30, kFrequency}},
    NamedUnit{"N", {1, kForce}},
    NamedUnit{"mN", {1e-3, kForce}},
    NamedUnit{"kN", {1e3, kForce}},
    NamedUnit{"Nm", {1, kMoment}},
    NamedUnit{"J", {1, kMoment}},
    NamedUnit{"W", {1, kPower}},
    NamedUnit{"kW", {1e3, kPower}},
};

}  // namespace

std::optional<Unit> find_unit(std::string_view name) {
  for (const auto& known : kUnits)
    if (name == known.name) return known.unit;
  return std::nullopt;
}

const std::vector<std::string>& unit_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& known : kUnits) all.emplace_back(known.name);
    return all;
  }();
  return names;
}

}  // namespace mixloop
