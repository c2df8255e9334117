// SPDX-License-Identifier: MIT
#include "loop/expectation.hpp"

#include <fmt/format.h>

#include <cmath>

#include "dynamics/scene/coordinate_values.hpp"
#include "loop/experiment_keys.hpp"
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

[[noreturn]] void refuse(const Place& place, const std::string& why) {
  throw InputError("out_of_range", place, why);
}

/// What is measured is a size: bounds on it are 0 or more, and leave room between them.
void check_bound(const Expectation::Bound& bound, const Node& node) {
  if (!(bound.least >= 0 && bound.most >= 0))
    refuse(
        node.place,
        fmt::format("the bound {} on {} is negative, and that is a size, never below 0; expected 0 or more",
                    describe(node), bound.name));
  if (!(bound.least <= bound.most))
    refuse(node.place,
           fmt::format("nothing lies between the bounds {:g} and {:g} on {}; expected [least, most]",
                       bound.least, bound.most, bound.name));
}

/// Neither the last error nor the mean one is above the largest, and none of a run that has not diverged
/// above the limit.
void check_possible(const Expectation& expectation, const Mapping& entry, double position_error_limit) {
  double most = position_error_limit;
  std::string limit = "limits.position_error";
  for (const auto& bound : expectation.bounds)
    if (bound.name == "max_position_error" && bound.most < most)
      most = bound.most, limit = "expect.max_position_error";
  for (const auto& bound : expectation.bounds)
    if (!bound.motor && bound.least > most)
      refuse(entry.at(bound.name)->place,
             fmt::format("{} is expected to be {:g} m or more, and {} lets it be {:g} m at most; expected "
                         "bounds that a run can meet",
                         bound.name, bound.least, limit, most));
}

/// Bounds are not judged where it diverges.
void check_divergence(const Expectation& expectation, const Mapping& entry) {
  if (!expectation.diverges) return;
  if (expectation.safe_state)
    refuse(entry.at("safe_state")->place,
           "a run ends where it diverges, and is not judged in its safe state; expected either 'diverges' or "
           "'safe_state'");
  if (!expectation.bounds.empty())
    refuse(
        entry.at(expectation.bounds.front().name)->place,
        fmt::format("beside 'diverges: true' no bound on {} is judged; expected either 'diverges' or bounds",
                    expectation.bounds.front().name));
}

}  // namespace

const Keys& expectation_keys() {
  static const Keys keys{"what is expected",
                         {{"max_position_error", form::numbers()},
                          {"final_position_error", form::numbers()},
                          {"rms_position_error", form::numbers()},
                          {"max_torque", form::numbers()},
                          {"diverges", form::flag()},
                          {"safe_state", form::flag()}}};
  return keys;
}

double Expectation::Bound::value_in(const Measures& measures) const {
  if (motor) return measures.max_torque[*motor];
  for (const auto& known : kErrors)
    if (name == known.name) return measures.*known.value;
  return kNeverMeasured;
}

Expectation read_expectation(const NodePtr& node, const Scene& scene, double position_error_limit) {
  const Mapping entry = read_mapping(node, expectation_keys());
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
        {known.name, std::nullopt, values.size() == 2 ? values[0] : 0.0, values.back(), "m"});
    check_bound(expectation.bounds.back(), *bound);
  }
  if (const NodePtr torque = entry.find("max_torque")) {
    const auto items = items_of(torque, "max_torque");
    if (items.size() != scene.motors().size())
      throw InputError("wrong_size", torque->place,
                       fmt::format("max_torque has {} values; expected {}", items.size(), scene.n_u()));
    for (std::size_t i = 0; i < items.size(); ++i) {
      const auto& motor = scene.motors()[i];
      expectation.bounds.push_back({"max_torque", static_cast<int>(i), 0.0,
                                    number_of(*items[i], kTorque.of(motor), "max_torque"),
                                    torque_unit(motor.linear)});
      check_bound(expectation.bounds.back(), *items[i]);
    }
  }
  if (const NodePtr diverges = entry.find("diverges")) expectation.diverges = flag_of(*diverges, "diverges");
  if (const NodePtr safe = entry.find("safe_state")) expectation.safe_state = flag_of(*safe, "safe_state");
  check_divergence(expectation, entry);
  check_possible(expectation, entry, position_error_limit);
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
    if (bound.holds(value)) continue;
    const bool torque = bound.motor.has_value();
    const double scale = torque ? 1 : 1e3;
    const std::string unit = torque ? bound.unit : "mm";
    const std::string name = torque ? fmt::format("{}[{}]", bound.name, *bound.motor) : bound.name;
    const std::string found =
        std::isnan(value) ? "was never measured" : fmt::format("is {:.6g} {}", value * scale, unit);
    const std::string expected =
        bound.least > 0 ? fmt::format("{:.6g} to {:.6g} {}", bound.least * scale, bound.most * scale, unit)
                        : fmt::format("at most {:.6g} {}", bound.most * scale, unit);
    lines.push_back(fmt::format("{} {}; expected {}", name, found, expected));
  }
  return lines;
}

}  // namespace mixloop
