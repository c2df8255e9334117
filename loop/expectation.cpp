// SPDX-License-Identifier: MIT
#include "loop/expectation.hpp"

#include <fmt/format.h>

#include <limits>

#include "notation/value.hpp"

namespace mixloop {
namespace {

struct NamedMeasure {
  const char* name;
  double Measures::*value;
};
constexpr NamedMeasure kErrors[] = {{"max_position_error", &Measures::max_position_error},
                                    {"final_position_error", &Measures::final_position_error},
                                    {"rms_position_error", &Measures::rms_position_error}};

}  // namespace

double Expectation::Bound::value_in(const Measures& measures) const {
  if (motor) return measures.max_torque[*motor];
  for (const auto& known : kErrors)
    if (name == known.name) return measures.*known.value;
  return std::numeric_limits<double>::quiet_NaN();
}

Expectation read_expectation(const NodePtr& node, const Scene& scene) {
  const Mapping entry(node, "what is expected",
                      {"max_position_error", "final_position_error", "rms_position_error", "max_torque",
                       "diverges", "safe_state"});
  Expectation expectation;
  for (const auto& known : kErrors) {
    const NodePtr bound = entry.find(known.name);
    if (!bound) continue;
    const auto values = numbers_of(bound, kLength, 0, known.name);
    if (values.empty() || values.size() > 2)
      throw InputError(
          "wrong_size", bound->place,
          fmt::format("{} values for {}; expected a bound or [least, most]", values.size(), known.name));
    expectation.bounds.push_back(
        {known.name, std::nullopt, values.size() == 2 ? values[0] : 0.0, values.back()});
  }
  if (const NodePtr torque = entry.find("max_torque")) {
    const auto items = items_of(torque, "max_torque");
    if (items.size() != scene.motors().size())
      throw InputError("wrong_size", torque->place,
                       fmt::format("max_torque has {} values; expected {}", items.size(), scene.n()));
    for (std::size_t i = 0; i < items.size(); ++i)
      expectation.bounds.push_back(
          {"max_torque", static_cast<int>(i), 0.0,
           number_of(*items[i], scene.motors()[i].linear ? kForce : kMoment, "max_torque")});
  }
  if (const NodePtr diverges = entry.find("diverges")) expectation.diverges = flag_of(*diverges, "diverges");
  if (const NodePtr safe = entry.find("safe_state")) expectation.safe_state = flag_of(*safe, "safe_state");
  return expectation;
}

std::vector<std::string> missed(const Expectation& expectation, const Measures& measures) {
  std::vector<std::string> lines;
  if (measures.diverged_at.has_value() != expectation.diverges)
    lines.push_back(expectation.diverges ? "it did not diverge; expected divergence"
                                         : fmt::format("it diverged at {:.6g} s", *measures.diverged_at));
  if (measures.safe_at.has_value() != expectation.safe_state)
    lines.push_back(expectation.safe_state
                        ? "it kept out of its safe state; expected that"
                        : fmt::format("it went into its safe state at {:.6g} s", *measures.safe_at));
  if (measures.diverged_at) return lines;
  for (const auto& bound : expectation.bounds) {
    const double value = bound.value_in(measures);
    if (value >= bound.least && value <= bound.most) continue;
    const bool torque = bound.motor.has_value();
    const double scale = torque ? 1 : 1e3;
    const char* unit = torque ? "N m" : "mm";
    const std::string name = torque ? fmt::format("{}[{}]", bound.name, *bound.motor) : bound.name;
    lines.push_back(bound.least > 0
                        ? fmt::format("{} is {:.6g} {}; expected {:.6g} to {:.6g} {}", name, value * scale,
                                      unit, bound.least * scale, bound.most * scale, unit)
                        : fmt::format("{} is {:.6g} {}; expected at most {:.6g} {}", name, value * scale,
                                      unit, bound.most * scale, unit));
  }
  return lines;
}

}  // namespace mixloop
