// SPDX-License-Identifier: MIT
#include "notation/unit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include "notation/nearest.hpp"
#include "notation/words.hpp"

namespace mixloop {
namespace {

struct NamedUnit {
  const char* name;
  Unit unit;
};

constexpr double kPi = std::numbers::pi;
constexpr Dimension kPower{4, 2, -6, false};

constexpr std::array kUnits = {
    NamedUnit{"m", {1, kLength}},        NamedUnit{"cm", {1e-2, kLength}},
    NamedUnit{"mm", {1e-3, kLength}},    NamedUnit{"um", {1e-6, kLength}},
    NamedUnit{"km", {1e3, kLength}},     NamedUnit{"kg", {1, kMass}},
    NamedUnit{"s", {1, kTime}},          NamedUnit{"ms", {1e-3, kTime}},
    NamedUnit{"us", {1e-6, kTime}},      NamedUnit{"ns", {1e-9, kTime}},
    NamedUnit{"min", {60, kTime}},       NamedUnit{"Hz", {1, kFrequency}},
    NamedUnit{"kHz", {1e3, kFrequency}}, NamedUnit{"MHz", {1e6, kFrequency}},
    NamedUnit{"rad", {1, kPure}},        NamedUnit{"deg", {kPi / 180, kPure}},
    NamedUnit{"rev", {2 * kPi, kPure}},  NamedUnit{"rpm", {kPi / 30, kFrequency}},
    NamedUnit{"N", {1, kForce}},         NamedUnit{"mN", {1e-3, kForce}},
    NamedUnit{"kN", {1e3, kForce}},      NamedUnit{"Nm", {1, kMoment}},
    NamedUnit{"J", {1, kMoment}},        NamedUnit{"W", {1, kPower}},
    NamedUnit{"kW", {1e3, kPower}},
};

/// How much one of it is of a unit of ours.
struct Worth {
  std::string_view word;
  double factor;
  std::string_view unit;
};

constexpr std::array kForeign = {
    Worth{"t", 1000, "kg"},     Worth{"lb", 0.45359237, "kg"},      Worth{"oz", 0.028349523125, "kg"},
    Worth{"in", 0.0254, "m"},   Worth{"inch", 0.0254, "m"},         Worth{"ft", 0.3048, "m"},
    Worth{"foot", 0.3048, "m"}, Worth{"feet", 0.3048, "m"},         Worth{"h", 3600, "s"},
    Worth{"hr", 3600, "s"},     Worth{"hour", 3600, "s"},           Worth{"Nmm", 1e-3, "N m"},
    Worth{"Ncm", 1e-2, "N m"},  Worth{"lbf", 4.4482216152605, "N"}, Worth{"kgf", 9.80665, "N"},
    Worth{"mps", 1, "m/s"},     Worth{"kmh", 1 / 3.6, "m/s"},       Worth{"rps", 1, "rev/s"}};
constexpr std::array kBases = {Worth{"g", 1e-3, "kg"}, Worth{"m", 1, "m"},     Worth{"s", 1, "s"},
                               Worth{"Hz", 1, "Hz"},   Worth{"rad", 1, "rad"}, Worth{"N", 1, "N"},
                               Worth{"Nm", 1, "N m"},  Worth{"J", 1, "J"},     Worth{"W", 1, "W"}};
constexpr std::array<std::pair<char, double>, 9> kPrefixes = {{{'n', 1e-9},
                                                               {'u', 1e-6},
                                                               {'m', 1e-3},
                                                               {'c', 1e-2},
                                                               {'d', 1e-1},
                                                               {'h', 1e2},
                                                               {'k', 1e3},
                                                               {'M', 1e6},
                                                               {'G', 1e9}}};

std::string worth_of(std::string_view word) {
  const auto text = [&](double factor, std::string_view unit) {
    return factor == 1 ? fmt::format("; did you mean '{}'?", unit)
                       : fmt::format("; 1 {} is {:.9g} {}", word, factor, unit);
  };
  for (const auto& foreign : kForeign)
    if (word == foreign.word) return text(foreign.factor, foreign.unit);
  for (const auto& base : kBases) {
    if (word == base.word) return text(base.factor, base.unit);
    for (const auto& [prefix, factor] : kPrefixes)
      if (word.size() == base.word.size() + 1 && word[0] == prefix && word.substr(1) == base.word)
        return text(factor * base.factor, base.unit);
  }
  return "";
}

/// Whether `unit` may be meant and no other power of ten: it begins as the word does, or is it in other
/// letters, of which m and M are thousandths and millions.
bool is_alike(std::string_view word, std::string_view unit) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  if (!word.empty() && word[0] == unit[0]) return true;
  return lower(unit[0]) != 'm' && std::equal(word.begin(), word.end(), unit.begin(), unit.end(),
                                             [&](char a, char b) { return lower(a) == lower(b); });
}

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

std::string unit_hint(std::string_view word) {
  if (std::string worth = worth_of(word); !worth.empty()) return worth;
  std::vector<std::string> alike;
  for (const auto& name : unit_names())
    if (is_alike(word, name)) alike.push_back(name);
  if (const auto near = nearest(word, alike); !near.empty()) return "; did you mean '" + near + "'?";
  return "; expected one of " + joined(unit_names());
}

}  // namespace mixloop
