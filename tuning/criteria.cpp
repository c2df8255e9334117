// SPDX-License-Identifier: MIT
#include "tuning/criteria.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "notation/nearest.hpp"
#include "notation/utf8.hpp"

namespace mixloop {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// `max_torque` of `max_torque[0]`.
std::string family_of(const std::string& name) { return name.substr(0, name.find('[')); }

}  // namespace

double margin_at(const Margin& margin, const LinearLoop& loop, const Sampling& sampling, double narrowest) {
  switch (margin.kind) {
    case Margin::Kind::spectral_radius:
      return sampled_radius(loop, loop.feedback.gain(), sampling);
    case Margin::Kind::longest_tick:
      return longest_tick(loop, sampling.delay, sampling.tick, narrowest).value_or(kNoLimit);
    default:
      return longest_delay(loop, sampling.tick, sampling.tick / 16, narrowest).value_or(kNoLimit);
  }
}

double margin_at_start(const Margin& margin, const Limits& limits) {
  switch (margin.kind) {
    case Margin::Kind::longest_tick_without_delay:
      return limits.longest_tick_undelayed.value_or(kNoLimit);
    case Margin::Kind::longest_rk4_step:
      return limits.longest_rk4_step.value_or(kNoLimit);
    case Margin::Kind::fastest_pole:
      return limits.fastest_pole;
    case Margin::Kind::gain_margin_most:
      return limits.most_gain.value_or(kNoLimit);
    case Margin::Kind::gain_margin_least:
      return limits.least_gain.value_or(0);
    default:
      return limits.most_gain_of_motor[margin.motor].value_or(kNoLimit);
  }
}

Criteria::Criteria(const Columns& columns, const Experiment& experiment) {
  for (const auto& column : columns.all()) all_.push_back({column.name, column.unit, std::nullopt});
  if (!closes_loop(experiment)) return;
  using Kind = Margin::Kind;
  all_.push_back({"spectral_radius", "1", Margin{Kind::spectral_radius}});
  all_.push_back({"longest_tick", "s", Margin{Kind::longest_tick}});
  all_.push_back({"longest_delay", "s", Margin{Kind::longest_delay}});
  all_.push_back({"longest_tick_without_delay", "s", Margin{Kind::longest_tick_without_delay}});
  all_.push_back({"longest_rk4_step", "s", Margin{Kind::longest_rk4_step}});
  all_.push_back({"fastest_pole", "1/s", Margin{Kind::fastest_pole}});
  all_.push_back({"gain_margin.most", "1", Margin{Kind::gain_margin_most}});
  all_.push_back({"gain_margin.least", "1", Margin{Kind::gain_margin_least}});
  for (std::size_t i = 0; i < experiment.scene->motors().size(); ++i)
    all_.push_back({fmt::format("gain_margin_of_motor[{}]", i), "1", Margin{Kind::gain_margin_of_motor, i}});
}

std::vector<std::size_t> Criteria::named(const std::string& name, const Place& place) const {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < size(); ++i)
    if (all_[i].name == (name == "gain_margin" ? "gain_margin.most" : name) ||
        family_of(all_[i].name) == name)
      found.push_back(i);
  if (!found.empty()) return found;
  std::vector<std::string> names;
  for (const Criterion& one : all_) {
    if (std::ranges::find(names, family_of(one.name)) == names.end()) names.push_back(family_of(one.name));
    if (name.find('[') != std::string::npos && one.name.ends_with(']')) names.push_back(one.name);
  }
  throw InputError("unknown_value", place,
                   in_quotes(name) + " isn't measured of this experiment" + suggestion(name, names));
}

}  // namespace mixloop
