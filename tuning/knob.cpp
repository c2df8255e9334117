// SPDX-License-Identifier: MIT
#include "tuning/knob.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "notation/document_path.hpp"
#include "notation/formula.hpp"
#include "notation/functions/elementary.hpp"
#include "notation/utf8.hpp"
#include "notation/words.hpp"
#include "sweep/key.hpp"
#include "sweep/written_value.hpp"

namespace mixloop {
namespace {

constexpr double kFurther = 10;  // how many times what stands is looked at, where no ends are given

/// What an `--over` asks for, before it is known what stands there.
struct Asked {
  std::string key, from, to;  ///< no ends: both empty
  Place place;

  [[noreturn]] void fail(const std::string& code, const std::string& message) const {
    throw InputError(code, place, message);
  }
};

Asked asked_in(const std::string& text) {
  const std::size_t equals = text.find('=');
  Asked asked{std::string(trimmed(std::string_view(text).substr(0, equals))), "", "", {}};
  asked.place = {"--over " + asked.key};
  if (asked.key.empty())
    throw InputError("missing_key", {"--over"},
                     "no key in " + in_quotes(text) +
                         "; expected entries of the experiment, e.g. controller.kp,controller.kv=0.1..10");
  if (equals == std::string::npos) return asked;
  const std::string ends = text.substr(equals + 1);
  const std::size_t dots = ends.find("..");
  if (dots == std::string::npos)
    asked.fail("invalid_range",
               in_quotes(ends) + " has no two ends; expected FROM..TO, e.g. --over controller.kp=10..1000");
  asked.from = trimmed(std::string_view(ends).substr(0, dots));
  asked.to = trimmed(std::string_view(ends).substr(dots + 2));
  return asked;
}

/// What stands at a key; nothing where there is nothing.
NodePtr node_at(const Asked& asked, const NodePtr& experiment, const ExperimentScenes& scenes) {
  const bool of_scene = is_of_scene(asked.key);
  NodePtr node = of_scene ? scenes.document : experiment;
  const auto key = std::string_view(asked.key).substr(of_scene ? asked.key.find('.') + 1 : 0);
  for (const PathStep& step : path_steps(key, asked.place)) {
    if (!node) return nullptr;
    if (step.is_index)
      node = node->kind == Node::Kind::sequence && step.index < node->items.size() ? node->items[step.index]
                                                                                   : nullptr;
    else
      node = node->kind == Node::Kind::mapping ? find_entry(*node, step.key) : nullptr;
  }
  return node;
}

/// What one of a unit is in SI, and of which dimension.
Formula worth_of(const Asked& asked, const std::string& unit) {
  return parse_formula(Node{.kind = Node::Kind::scalar, .place = asked.place, .text = "1 " + unit}, asked.key,
                       Scope());
}

/// An end, in the unit of what stands there.
double end_of(const Asked& asked, const std::string& text, const std::string& other,
              const Measure& standing) {
  auto end = measure_in(text);
  if (!end)
    asked.fail("invalid_range",
               in_quotes(text) + " is no number; expected FROM..TO, e.g. --over controller.kp=10..1000");
  if (end->unit.empty())
    if (const auto shared = measure_in(other)) end->unit = shared->unit;
  if (end->unit.empty() || end->unit == standing.unit) return end->number;
  const Formula theirs = worth_of(asked, end->unit), ours = worth_of(asked, standing.unit);
  if (!standing.unit.empty() && !theirs.dimension.same_powers(ours.dimension))
    asked.fail("wrong_dimension",
               fmt::format("{} is {}, and what stands there is in {}; expected {}", in_quotes(text),
                           to_string(theirs.dimension), standing.unit, to_string(ours.dimension)));
  return end->number * theirs.constant() / (standing.unit.empty() ? 1 : ours.constant());
}

/// To six digits, as people write numbers.
double rounded(double value) {
  const std::string text = fmt::format("{:.6g}", value);
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

Knob knob_of(const Asked& asked, const std::string& key, const Node& node) {
  const auto standing = node.kind == Node::Kind::scalar ? measure_in(node.text) : std::nullopt;
  if (!standing)
    asked.fail("wrong_kind", fmt::format("what stands at {} is {}; expected a number, or a list of numbers",
                                         in_quotes(key), describe(node)));
  Knob knob{.key = key, .place = asked.place, .unit = standing->unit, .now = standing->number};
  if (asked.from.empty() && asked.to.empty()) {
    if (knob.now == 0)
      asked.fail("out_of_range",
                 fmt::format("{} is 0, of which a tenth and ten times say nothing; expected two ends, e.g. "
                             "--over {}=FROM..TO",
                             in_quotes(key), key));
    knob.least = rounded(knob.now > 0 ? knob.now / kFurther : knob.now * kFurther);
    knob.most = rounded(knob.now > 0 ? knob.now * kFurther : knob.now / kFurther);
    return knob;
  }
  knob.least = end_of(asked, asked.from, asked.to, *standing);
  knob.most = end_of(asked, asked.to, asked.from, *standing);
  if (!(knob.least < knob.most))
    asked.fail("out_of_range",
               fmt::format("from {} to {}: an empty range; expected from below to", asked.from, asked.to));
  if (knob.now < knob.least || knob.now > knob.most)
    asked.fail("out_of_range", fmt::format("{} is {}, outside of {}..{}; expected ends around what stands "
                                           "there, where the search begins (--set puts it elsewhere)",
                                           in_quotes(key), knob.text_of(knob.now), asked.from, asked.to));
  return knob;
}

void add_knobs(const Asked& asked, const std::string& key, const Node& node, std::vector<Knob>& knobs) {
  if (node.kind != Node::Kind::sequence) {
    knobs.push_back(knob_of(asked, key, node));
    return;
  }
  for (std::size_t i = 0; i < node.items.size(); ++i)
    add_knobs(asked, fmt::format("{}[{}]", key, i), *node.items[i], knobs);
}

}  // namespace

// By the program's own functions, so that no C library decides a digit.
double Knob::value(double share) const {
  using mixloop_functions::exp, mixloop_functions::log;
  const double way = std::clamp(share, 0.0, 1.0);
  const double value =
      is_logarithmic() ? least * exp(way * log(most / least)) : least * (1 - way) + most * way;
  const bool is_zero = !is_logarithmic() && std::abs(value) < 1e-7 * (most - least);  // but for rounding
  return std::clamp(is_zero ? 0 : rounded(value), least, most);
}

double Knob::share(double value) const {
  using mixloop_functions::log;
  return is_logarithmic() ? log(value / least) / log(most / least) : (value - least) / (most - least);
}

std::string Knob::text_of(double value) const {
  return fmt::format("{}{}{}", value, unit.empty() ? "" : " ", unit);
}

Variation Knob::as_variation() const {
  Variation variation;
  variation.key = key;
  variation.place = place;
  variation.unit = unit;
  variation.numbers = {now};
  return variation;
}

std::vector<Knob> read_knobs(const std::vector<std::string>& over, const NodePtr& experiment,
                             const ExperimentScenes& scenes) {
  std::vector<Knob> knobs;
  for (const std::string& option : over)
    for (const std::string& text : parts_of(option)) {
      const Asked asked = asked_in(text);
      Variation named;
      named.key = asked.key;
      named.place = asked.place;
      require_key(named, experiment, scenes);
      const NodePtr node = node_at(asked, experiment, scenes);
      if (!node)
        asked.fail("missing_key",
                   fmt::format("nothing stands at {}, so that there is nothing to begin from; expected an "
                               "entry with a number (--set {}=... puts one there)",
                               in_quotes(asked.key), asked.key));
      add_knobs(asked, asked.key, *node, knobs);
    }
  if (knobs.empty())
    throw InputError("missing_key", {"--over"},
                     "nothing is tuned; expected --over KEY, e.g. --over controller.kp,controller.kv");
  return knobs;
}

}  // namespace mixloop
