// SPDX-License-Identifier: MIT
#include "loop/expectation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "dynamics/scene/coordinate_values.hpp"
#include "loop/experiment_keys.hpp"
#include "notation/value.hpp"
#include "plant/read_each.hpp"

namespace mixloop {
namespace {

struct NamedMeasure {
  const char* name;
  double Measures::*value;
};
constexpr NamedMeasure kErrors[] = {{"max_position_error", &Measures::max_position_error},
                                    {"final_position_error", &Measures::final_position_error},
                                    {"rms_position_error", &Measures::rms_position_error}};

constexpr const char *kFinal = "final_psi", *kDrift = "energy_drift", *kMotorError = "max_motor_error",
                     *kOrientation = "max_orientation_error";

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

bool is_error(const Expectation::Bound& bound) {
  return std::ranges::find(kErrors, bound.name, &NamedMeasure::name) != std::end(kErrors);
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
    if (is_error(bound) && bound.least > most)
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
        entry.at(expectation.bounds.front().name == kFinal ? "final" : expectation.bounds.front().name)
            ->place,
        fmt::format("beside 'diverges: true' no bound on {} is judged; expected either 'diverges' or bounds",
                    expectation.bounds.front().name));
}

void read_error_bounds(const Mapping& entry, bool has_path, Expectation& expectation) {
  for (const auto& known : kErrors) {
    const NodePtr bound = entry.find(known.name);
    if (!bound) continue;
    if (!has_path)
      refuse(bound->place,
             fmt::format("without a path there is no {}; expected bounds on final, energy_drift "
                         "or max_torque",
                         known.name));
    const auto values = numbers_of(bound, kLength, 0, known.name);
    if (values.empty() || values.size() > 2)
      throw InputError(
          "wrong_size", bound->place,
          fmt::format("{} values for {}; expected a bound or [least, most]", values.size(), known.name));
    expectation.bounds.push_back(
        {known.name, std::nullopt, values.size() == 2 ? values[0] : 0.0, values.back(), "m"});
    check_bound(expectation.bounds.back(), *bound);
  }
}

/// A bound for each motor.
void read_motor_bounds(const NodePtr& node, const std::string& name, const Quantity& quantity,
                       const Scene& scene, Expectation& expectation) {
  const auto items = items_of(node, name);
  if (items.size() != scene.motors().size())
    throw InputError("wrong_size", node->place,
                     fmt::format("{} has {} values; expected {}", name, items.size(), scene.n_u()));
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto& motor = scene.motors()[i];
    expectation.bounds.push_back(
        {name, static_cast<int>(i), 0.0, number_of(*items[i], quantity.of(motor), name),
         name == kMotorError ? position_unit(motor.linear) : torque_unit(motor.linear)});
    check_bound(expectation.bounds.back(), *items[i]);
  }
}

void read_motor_error_bounds(const Mapping& entry, const Scene& scene, bool is_of_motors,
                             Expectation& expectation) {
  const NodePtr errors = entry.find(kMotorError);
  if (!errors) return;
  if (!is_of_motors)
    refuse(errors->place,
           "max_motor_error is of a path of the motors, and this experiment has none; expected "
           "another bound");
  read_motor_bounds(errors, kMotorError, kPosition, scene, expectation);
}

void read_orientation_bound(const Mapping& entry, const Scene& scene, bool has_path,
                            Expectation& expectation) {
  const NodePtr error = entry.find(kOrientation);
  if (!error) return;
  if (!has_path || !scene.end_effector.is_oriented())
    refuse(error->place,
           "nothing prescribes how the end effector is turned; expected end_effector.axes with rx, ry, rz "
           "or its direction in the scene, or no max_orientation_error");
  expectation.bounds.push_back(
      {kOrientation, std::nullopt, 0.0, number_of(*error, kPure, kOrientation), "rad"});
  check_bound(expectation.bounds.back(), *error);
}

/// Where the independent coordinates shall be at the end, each to its tolerance.
void read_final_bounds(const Mapping& entry, const Scene& scene, Expectation& expectation) {
  const NodePtr final = entry.find("final"), tolerance = entry.find("tolerance");
  if (!final && !tolerance) return;
  if (!final || !tolerance)
    throw InputError("missing_key", (final ? final : tolerance)->place,
                     final ? "what is expected lacks 'tolerance', to which 'final' is to hold"
                           : "what is expected has a tolerance, and lacks 'final', which it is of");
  const auto psi = read_values(final, scene.independent, kPosition, "the final position");
  const auto within =
      read_each(tolerance, scene.independent, kPosition, {0, kNoLimit, "0 or more"}, "the tolerance");
  for (std::size_t i = 0; i < psi.size(); ++i)
    expectation.bounds.push_back({kFinal, static_cast<int>(i), psi[i] - within[i], psi[i] + within[i],
                                  position_unit(scene.independent[i].linear)});
}

void read_drift_bound(const Mapping& entry, Expectation& expectation) {
  const NodePtr drift = entry.find(kDrift);
  if (!drift) return;
  expectation.bounds.push_back({kDrift, std::nullopt, 0.0, number_of(*drift, kPure, "the energy drift"), ""});
  check_bound(expectation.bounds.back(), *drift);
}

/// "0.1 to 0.2 rad", "at most 13 mm".
std::string expected_text(const Expectation::Bound& bound, double scale, const std::string& unit) {
  if (bound.name == kFinal) return fmt::format("{:.12g} to {:.12g}{}", bound.least, bound.most, unit);
  if (bound.least > 0)
    return fmt::format("{:.6g} to {:.6g}{}", bound.least * scale, bound.most * scale, unit);
  return fmt::format("at most {:.6g}{}", bound.most * scale, unit);
}

}  // namespace

const Keys& expectation_keys() {
  static const Keys keys{"what is expected",
                         {{"max_position_error", form::numbers()},
                          {"final_position_error", form::numbers()},
                          {"rms_position_error", form::numbers()},
                          {"max_orientation_error", form::number()},
                          {"max_motor_error", form::numbers()},
                          {"max_torque", form::numbers()},
                          {"final", form::numbers()},
                          {"tolerance", form::numbers()},
                          {"energy_drift", form::number()},
                          {"diverges", form::flag()},
                          {"safe_state", form::flag()}}};
  return keys;
}

double Expectation::Bound::value_in(const Measures& measures) const {
  if (name == kFinal) return measures.final_psi ? (*measures.final_psi)[*motor] : kNeverMeasured;
  if (name == kDrift) return measures.energy_drift.value_or(kNeverMeasured);
  if (name == kMotorError)
    return measures.max_motor_error ? (*measures.max_motor_error)[*motor] : kNeverMeasured;
  if (name == kOrientation) return measures.max_orientation_error;
  if (motor) return measures.max_torque[*motor];
  for (const auto& known : kErrors)
    if (name == known.name) return measures.*known.value;
  return kNeverMeasured;
}

bool Expectation::bounds_on(std::string_view name) const {
  return std::ranges::find(bounds, name, &Bound::name) != bounds.end();
}

Expectation read_expectation(const NodePtr& node, const Scene& scene,
                             std::optional<double> position_error_limit, bool is_of_motors) {
  const Mapping entry = read_mapping(node, expectation_keys());
  Expectation expectation;
  read_error_bounds(entry, position_error_limit.has_value(), expectation);
  read_orientation_bound(entry, scene, position_error_limit.has_value(), expectation);
  if (const NodePtr torque = entry.find("max_torque"))
    read_motor_bounds(torque, "max_torque", kTorque, scene, expectation);
  read_motor_error_bounds(entry, scene, is_of_motors, expectation);
  read_final_bounds(entry, scene, expectation);
  read_drift_bound(entry, expectation);
  if (const NodePtr diverges = entry.find("diverges")) expectation.diverges = flag_of(*diverges, "diverges");
  if (const NodePtr safe = entry.find("safe_state")) expectation.safe_state = flag_of(*safe, "safe_state");
  check_divergence(expectation, entry);
  if (position_error_limit) check_possible(expectation, entry, *position_error_limit);
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
    const double scale = is_error(bound) ? 1e3 : 1;
    const std::string unit = is_error(bound) ? " mm" : bound.unit.empty() ? "" : " " + bound.unit;
    const std::string name = bound.motor ? fmt::format("{}[{}]", bound.name, *bound.motor) : bound.name;
    const std::string found = std::isnan(value)      ? "was never measured"
                              : bound.name == kFinal ? fmt::format("is {:.12g}{}", value, unit)
                                                     : fmt::format("is {:.6g}{}", value * scale, unit);
    const std::string expected = expected_text(bound, scale, unit);
    lines.push_back(fmt::format("{} {}; expected {}", name, found, expected));
  }
  return lines;
}

}  // namespace mixloop
