// SPDX-License-Identifier: MIT
#include "tuning/bound.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "notation/document.hpp"
#include "notation/formula.hpp"
#include "notation/utf8.hpp"
#include "notation/words.hpp"
#include "sweep/written_value.hpp"

namespace mixloop {
namespace {

constexpr const char* kExample =
    "expected NAME < BOUND, or one of <=, >, >=, e.g. 'max_torque < 5 N m', 'longest_delay >= now'";

/// A number in the criterion's own unit, which is SI.
double number_in(const std::string& text, const Criteria::Criterion& criterion, const Place& place) {
  const Node scalar{.kind = Node::Kind::scalar, .place = place, .text = text};
  const Formula formula = parse_formula(scalar, criterion.name, Scope());
  const Node one{.kind = Node::Kind::scalar, .place = place, .text = "1 " + criterion.unit};
  require_dimension(formula,
                    criterion.unit == "1" ? kPure : parse_formula(one, criterion.name, Scope()).dimension,
                    criterion.name);
  return formula.constant();
}

/// The texts of a bound, one a criterion or one for all; the unit behind a list is that of each.
std::vector<std::string> limits_in(const std::string& text, const Place& place) {
  if (!text.starts_with('[')) return {text};
  const std::size_t close = text.find(']');
  if (close == std::string::npos)
    throw InputError("invalid_range", place, in_quotes(text) + " lacks its ']'; " + kExample);
  std::vector<std::string> limits = parts_of(std::string_view(text).substr(1, close - 1));
  const std::string unit(trimmed(std::string_view(text).substr(close + 1)));
  for (std::string& limit : limits)
    if (const auto measure = measure_in(limit); measure && measure->unit.empty() && !unit.empty())
      limit += " " + unit;
  return limits;
}

void take_limit(Bound& bound, const std::string& text, const Criteria& criteria) {
  const auto measure = measure_in(text);
  if (text == "now" || (measure && measure->unit == "now")) {
    bound.times_now = measure ? measure->number : 1;
    return;
  }
  bound.limit = number_in(text, criteria[bound.criterion], bound.place);
}

}  // namespace

Goal read_goal(const std::string& name, bool maximises, const Criteria& criteria) {
  const Place place{maximises ? "--maximise" : "--minimise"};
  if (name.empty())
    throw InputError(
        "missing_key", {"tune"},
        "nothing says what is to be tuned for; expected --minimise NAME or --maximise NAME, e.g. "
        "--minimise max_position_error");
  Goal goal{.name = std::string(trimmed(name)), .criteria = {}, .maximises = maximises};
  goal.criteria = criteria.named(goal.name, place);
  for (const std::size_t one : goal.criteria)
    if (criteria[one].unit != criteria[goal.criteria[0]].unit)
      throw InputError("wrong_dimension", place,
                       fmt::format("{} are of several units; expected one of them, e.g. {}", goal.name,
                                   criteria[goal.criteria[0]].name));
  return goal;
}

std::vector<Bound> read_bounds(const std::string& text, const Criteria& criteria) {
  const Place place{"--subject " + text};
  const std::size_t at = text.find_first_of("<>");
  if (at == std::string::npos)
    throw InputError("invalid_range", place, "no '<' or '>' in it; " + std::string(kExample));
  const bool or_equal = at + 1 < text.size() && text[at + 1] == '=';
  const std::string name(trimmed(std::string_view(text).substr(0, at)));
  const std::string limit(trimmed(std::string_view(text).substr(at + (or_equal ? 2 : 1))));
  if (limit.empty())
    throw InputError("invalid_range", place, "nothing stands behind its sign; " + std::string(kExample));
  const auto found = criteria.named(name, place);
  const auto limits = limits_in(limit, place);
  if (limits.size() != 1 && limits.size() != found.size())
    throw InputError("wrong_size", place,
                     fmt::format("{} bounds for {} numbers; expected one for all, or a list of {}",
                                 limits.size(), found.size(), found.size()));
  std::vector<Bound> bounds;
  for (std::size_t i = 0; i < found.size(); ++i) {
    bounds.push_back({.text = std::string(trimmed(text)),
                      .place = place,
                      .criterion = found[i],
                      .is_upper = text[at] == '<',
                      .is_strict = !or_equal});
    take_limit(bounds.back(), limits[limits.size() == 1 ? 0 : i], criteria);
  }
  return bounds;
}

}  // namespace mixloop
