// SPDX-License-Identifier: MIT
#include "controller/torque_course.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>

#include "dynamics/scene/coordinate_values.hpp"
#include "notation/utf8.hpp"
#include "notation/words.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kMostNumbers = 50'000'000;  // of a table, 400 MB

/// A table's line, read field by field.
class Row {
 public:
  Row(std::string_view line, const std::string& file, int number)
      : line_(line), place_{file, number, 1}, more_(true) {}

  bool more() const { return more_; }
  /// Where the latest field stands.
  const Place& place() const { return place_; }

  std::string_view next() {
    const std::size_t comma = line_.find(',', at_), end = std::min(comma, line_.size());
    const std::string_view field = trimmed(line_.substr(at_, end - at_));
    // Column by bytes, from 1: of an empty field, where it would stand.
    place_.column =
        1 + static_cast<int>(field.empty() ? at_ : static_cast<std::size_t>(field.data() - line_.data()));
    more_ = comma != std::string_view::npos;
    at_ = end + 1;
    return field;
  }

 private:
  std::string_view line_;
  std::size_t at_ = 0;
  Place place_;
  bool more_;
};

[[noreturn]] void refuse_table(const Place& place, const std::string& why) {
  throw InputError("invalid_table", place, why);
}

double number_in(std::string_view field, const Place& place, const std::string& what) {
  double value = 0;
  const bool plus = field.starts_with('+') && !field.starts_with("+-");
  const std::string_view digits = field.substr(plus ? 1 : 0);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (digits.empty() || error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
    refuse_table(
        place, fmt::format("found {}; expected {}, a finite number in SI",
                           field.empty() ? "nothing" : in_quotes(printable(std::string(field.substr(0, 40)))),
                           what));
  return value;
}

std::string torque_name(const Scene& scene, std::size_t i) {
  const auto& motor = scene.motors()[i];
  return fmt::format("the {} of motor '{}'", motor.linear ? "force" : "torque", motor.name);
}

}  // namespace

TorqueCourse TorqueCourse::of_formulas(const NodePtr& node, const Scene& scene) {
  const auto motors = scene.motors();
  const auto items = items_of(node, "the torques, a formula of t a motor");
  if (items.size() != motors.size())
    throw InputError("wrong_size", node->place,
                     fmt::format("torque has {} formulas; expected one for each of the {} motors",
                                 items.size(), motors.size()));
  Scope time;
  time.define_symbol("t", Symbols::kTime, kTime, node->place);
  TorqueCourse course;
  for (std::size_t i = 0; i < motors.size(); ++i) {
    const std::string what = torque_name(scene, i);
    course.formulas_.push_back(parse_formula(*items[i], what, time));
    require_dimension(course.formulas_.back(), kTorque.of(motors[i]), what);
  }
  return course;
}

TorqueCourse TorqueCourse::of_file(const Node& node, const std::filesystem::path& folder,
                                   const Scene& scene) {
  const std::filesystem::path path = folder / text_of(node, "the path of a CSV file of torques");
  std::error_code failed;
  std::ifstream in(path);
  if (!std::filesystem::is_regular_file(path, failed) || !in)
    throw InputError(
        "no_such_file", node.place,
        "no file of torques at " + describe(node) + " (its path counts from the experiment's folder)");
  const std::size_t n_u = scene.motors().size();
  const std::string file = path.string();
  TorqueCourse course;
  std::string line;
  int number = 0;
  bool may_be_header = true;
  while (std::getline(in, line)) {
    Row row(line, file, ++number);
    if (const auto text = trimmed(line); text.empty() || text.starts_with('#')) continue;
    const std::string_view first = row.next();
    if (std::exchange(may_be_header, false) && first == "t") continue;
    const double t = number_in(first, row.place(), "the time");
    if (course.times_.empty() && t > 0)
      refuse_table(row.place(), fmt::format("the first sample is at {:g} s; expected one at 0 s, where the "
                                            "run begins, or before",
                                            t));
    if (!course.times_.empty() && !(t > course.times_.back()))
      refuse_table(row.place(), fmt::format("the time {:g} s comes after {:g} s; expected times that ascend",
                                            t, course.times_.back()));
    for (std::size_t i = 0; i < n_u; ++i) {
      if (!row.more())
        refuse_table({file, number, 1 + static_cast<int>(line.size())},
                     fmt::format("the row ends after {} numbers; expected {}: t, and a value a motor", i + 1,
                                 n_u + 1));
      const std::string_view field = row.next();
      course.samples_.push_back(number_in(field, row.place(), torque_name(scene, i)));
    }
    if (row.more()) {
      row.next();
      refuse_table(row.place(),
                   fmt::format("the row goes on after {} numbers; expected t, and a value a motor", n_u + 1));
    }
    course.times_.push_back(t);
    if (course.samples_.size() > kMostNumbers)
      refuse_table({file, number},
                   fmt::format("more than {} numbers; expected a shorter table", kMostNumbers));
  }
  if (course.times_.empty())
    refuse_table({file, std::max(number, 1)}, "no sample; expected rows of t and a value a motor");
  return course;
}

void TorqueCourse::at(double t, std::span<double> tau) const {
  if (!formulas_.empty()) {
    for (std::size_t i = 0; i < formulas_.size(); ++i)
      tau[i] = evaluate<double>(formulas_[i], [t](int) { return t; });
    return;
  }
  // The first sample is at 0 s or before.
  const auto after = std::upper_bound(times_.begin() + 1, times_.end(), t);
  const auto row = static_cast<std::size_t>(after - times_.begin()) - 1;
  std::copy_n(samples_.begin() + static_cast<std::ptrdiff_t>(row * tau.size()), tau.size(), tau.begin());
}

}  // namespace mixloop
