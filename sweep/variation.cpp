// SPDX-License-Identifier: MIT
#include "sweep/variation.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "loop/inputs.hpp"
#include "notation/nearest.hpp"
#include "notation/utf8.hpp"
#include "notation/value.hpp"
#include "notation/words.hpp"
#include "sweep/written_value.hpp"

namespace mixloop {
namespace {

constexpr std::int64_t kMostValues = 1'000'000;

/// Numbers of one unit, which those that have none share; nothing where a text is no number, or units differ.
std::optional<Variation> numbers_in(const std::vector<std::string>& texts) {
  Variation numbers;
  for (const auto& text : texts) {
    const auto measure = measure_in(text);
    if (!measure) return std::nullopt;
    if (!measure->unit.empty() && !numbers.unit.empty() && measure->unit != numbers.unit) return std::nullopt;
    if (!measure->unit.empty()) numbers.unit = measure->unit;
    numbers.numbers.push_back(measure->number);
  }
  return numbers;
}

/// What a person wrote of one entry: for its messages.
struct Written {
  std::string key, value;
  Place place;

  [[noreturn]] void fail(const std::string& code, const std::string& message) const {
    throw InputError(code, place, message);
  }
  Variation named(Variation variation) const {
    variation.key = key;
    variation.place = place;
    // A unit that is none, and any other slip, is told where it stands.
    if (!variation.unit.empty())
      parse_formula(Node{.kind = Node::Kind::scalar, .place = place, .text = "1 " + variation.unit}, key,
                    Scope());
    return variation;
  }
};

/// To 15 digits, as people write numbers: 0.3, not 0.30000000000000004.
double rounded(double number) {
  const std::string text = fmt::format("{:.15g}", number);
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

Variation range_of(const Written& written, std::size_t dots) {
  const std::string& value = written.value;
  static constexpr const char* kExpected = "expected from..to:count, e.g. 0..5 kg:11";
  const std::size_t colon = value.rfind(':');
  if (colon == std::string::npos || colon < dots)
    written.fail("invalid_range", in_quotes(value) + " doesn't say how many values; " + kExpected);
  const std::string many(trimmed(std::string_view(value).substr(colon + 1)));
  std::int64_t count = 0;
  const auto [end, error] = std::from_chars(many.data(), many.data() + many.size(), count);
  if (error != std::errc() || end != many.data() + many.size() || many.empty())
    written.fail("invalid_range", in_quotes(many) + " is no number of values; " + kExpected);
  if (count < 1 || count > kMostValues)
    written.fail("out_of_range",
                 fmt::format("{} values of '{}'; expected 1 to {}", count, written.key, kMostValues));
  auto ends = numbers_in({std::string(trimmed(std::string_view(value).substr(0, dots))),
                          std::string(trimmed(std::string_view(value).substr(dots + 2, colon - dots - 2)))});
  if (!ends)
    written.fail("invalid_range",
                 in_quotes(value) + " has not two numbers of one unit; " + std::string(kExpected));
  const double from = ends->numbers[0], to = ends->numbers[1];
  if ((from == to) != (count == 1))
    written.fail("out_of_range",
                 fmt::format("{} values from {} to {}: an empty range; expected two ends that differ, and "
                             "two values or more",
                             count, from, to));
  ends->numbers.clear();
  for (std::int64_t i = 0; i < count; ++i) {
    const double share = count == 1 ? 0 : static_cast<double>(i) / static_cast<double>(count - 1);
    ends->numbers.push_back(rounded(from * (1 - share) + to * share));
  }
  return written.named(*ends);
}

Variation listed(const Written& written, const std::vector<std::string>& texts) {
  for (const auto& text : texts)
    if (text.empty())
      written.fail("wrong_size", "no value for '" + written.key +
                                     "', or none between two commas; expected "
                                     "values parted by commas, e.g. 1,2,5 kg");
  if (auto numbers = numbers_in(texts)) return written.named(std::move(*numbers));
  Variation listed;
  listed.texts = texts;
  return written.named(std::move(listed));
}

Variation varied(const Written& written) {
  const std::size_t dots = written.value.find("..");
  return dots == std::string::npos ? listed(written, parts_of(written.value)) : range_of(written, dots);
}

Variation sampled(const Written& written) {
  static const std::vector<std::string> kNames = {"normal", "uniform"};
  static constexpr const char* kExpected = "expected normal(mean, std) or uniform(from, to)";
  const std::string& value = written.value;
  const std::size_t open = value.find('(');
  const std::string name(trimmed(std::string_view(value).substr(0, open)));
  if (std::ranges::find(kNames, name) == kNames.end())
    written.fail("unknown_value", in_quotes(name) + " is nothing to sample from" + suggestion(name, kNames));
  if (open == std::string::npos || !value.ends_with(')'))
    written.fail("invalid_range", in_quotes(value) + " lacks its numbers; " + kExpected);
  auto numbers = numbers_in(parts_of(std::string_view(value).substr(open + 1, value.size() - open - 2)));
  if (!numbers || numbers->numbers.size() != 2)
    written.fail("invalid_range", in_quotes(value) + " has not two numbers of one unit; " + kExpected);
  const bool is_normal = name == "normal";
  const double first = numbers->numbers[0], second = numbers->numbers[1];
  if (is_normal ? !(second > 0) : !(first < second))
    written.fail("out_of_range",
                 is_normal
                     ? fmt::format("a standard deviation of {}; expected more than 0", second)
                     : fmt::format("from {} to {}: an empty range; expected from below to", first, second));
  numbers->numbers.clear();
  numbers->distribution = {.kind = is_normal ? Distribution::Kind::normal : Distribution::Kind::uniform,
                           .first = first,
                           .second = second};
  return written.named(*numbers);
}

Written written_in(const std::string& text, const std::string& option, const char* example) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError("invalid_override", {option + " " + text}, std::string("expected ") + example);
  Written written{std::string(trimmed(std::string_view(text).substr(0, equals))),
                  std::string(trimmed(std::string_view(text).substr(equals + 1))),
                  {}};
  written.place = {option + " " + written.key};
  return written;
}

}  // namespace

std::int64_t Variation::size() const {
  return static_cast<std::int64_t>(is_number() ? numbers.size() : texts.size());
}

std::string Variation::text_of(double number) const {
  return fmt::format("{}{}{}", number, unit.empty() ? "" : " ", unit);
}

std::string Variation::written() const {
  if (distribution)
    return fmt::format("{}({}, {})", distribution->kind == Distribution::Kind::normal ? "normal" : "uniform",
                       text_of(distribution->first), text_of(distribution->second));
  std::vector<std::string> listed = texts;
  for (const double number : numbers) listed.push_back(text_of(number));
  return joined(listed);
}

Variation parse_varied(const std::string& text) {
  return varied(written_in(text, "--vary",
                           "key=from..to:count or key=value,value,..., e.g. --vary "
                           "parameters.payload='0..5 kg:11'"));
}

Variation parse_sampled(const std::string& text) {
  return sampled(written_in(text, "--sample",
                            "key=normal(mean, std) or key=uniform(from, to), e.g. --sample "
                            "parameters.payload='normal(5 kg, 0.5 kg)'"));
}

Variation read_varied(const Node::Entry& entry) {
  if (entry.value->kind == Node::Kind::scalar)
    return varied({entry.key, std::string(trimmed(entry.value->text)), entry.value->place});
  std::vector<std::string> texts;
  for (const auto& item : items_of(entry.value, "the values of a varied entry"))
    texts.push_back(item->kind == Node::Kind::scalar ? item->text : line_of(*item));
  if (texts.empty())
    throw InputError("wrong_size", entry.value->place,
                     "no value for " + in_quotes(entry.key) + "; expected one or more");
  return listed({entry.key, "", entry.value->place}, texts);
}

Variation read_sampled(const Node::Entry& entry) {
  return sampled({entry.key, std::string(trimmed(mixloop::text_of(*entry.value, "what is sampled from"))),
                  entry.value->place});
}

}  // namespace mixloop
