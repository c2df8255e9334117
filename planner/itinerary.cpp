// SPDX-License-Identifier: MIT
#include "planner/itinerary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "notation/words.hpp"
#include "planner/cycloid.hpp"
#include "planner/orientation.hpp"

namespace mixloop {

namespace {

// Laps of that many steps, a million times, can still be counted in a double.
constexpr std::int64_t kMostSteps = std::int64_t{1} << 30;

[[noreturn]] void refuse_length(const Place& place, const std::string& what) {
  throw InputError("too_large", place, what + " has more than 2^30 steps of time");
}

}  // namespace

std::int64_t ticks_of(double seconds, double rate_hz, const Place& place, const std::string& what) {
  const double ticks = seconds * rate_hz, whole = std::round(ticks);
  if (!(whole <= static_cast<double>(kMostSteps))) refuse_length(place, what);
  if (std::abs(ticks - whole) > 1e-9 * whole)
    throw InputError(
        "off_grid", place,
        fmt::format("{} is {} s, which is {} ticks at {} Hz; expected a whole number, such as {} s", what,
                    seconds, ticks, rate_hz, std::max(whole, 1.0) / rate_hz));
  return static_cast<std::int64_t>(whole);
}

Itinerary::Itinerary(const Path& path, double rate_hz, int stages)
    : axes_(path.axes), step_rate_(rate_hz * stages) {
  const auto& vias = path.vias;
  const auto line = [&](std::size_t to) {
    return stages * ticks_of(vias[to].duration, rate_hz, vias[to].place, "the duration");
  };
  const auto rest = [&](std::size_t at) {
    if (vias[at].dwell > 0)
      add(stages * ticks_of(vias[at].dwell, rate_hz, vias[at].place, "the dwell"), vias[at], vias[at],
          vias[at].place);
  };
  rest(0);
  for (std::size_t i = 1; i < vias.size(); ++i) {
    add(line(i), vias[i - 1], vias[i], vias[i].place);
    rest(i);
  }
  if (path.repeat == 0) return;
  laps_ = path.repeat;
  for (std::size_t i = vias.size() - 1; i > 0; --i) {
    if (i + 1 < vias.size()) rest(i);
    add(line(i), vias[i], vias[i - 1], vias[i].place);
  }
}

bool Itinerary::Stretch::is_rest() const {
  return from.point == to.point && from.motors == to.motors && turn.isZero(0);
}

void Itinerary::add(std::int64_t count, const Path::Via& from, const Path::Via& to, const Place& place) {
  const std::int64_t first = stretches_.empty() ? 0 : lap_steps();
  if (first + count > kMostSteps) refuse_length(place, "the path");
  stretches_.push_back(
      {first, count, from, to, rotation_vector(to.rotation * from.rotation.transpose()), place});
}

Itinerary::Within Itinerary::within(double step) const {
  const auto lap = static_cast<double>(lap_steps());
  const double local = step >= static_cast<double>(steps()) ? lap : std::fmod(step, lap);
  const auto after = std::upper_bound(
      stretches_.begin() + 1, stretches_.end(), local,
      [](double at, const Stretch& stretch) { return at < static_cast<double>(stretch.first); });
  const Stretch& stretch = *(after - 1);
  return {stretch, (local - static_cast<double>(stretch.first)) / static_cast<double>(stretch.count)};
}

PathPoint Itinerary::at(double step) const {
  const auto [stretch, x] = within(step);
  const auto [s, sd, sdd] = cycloid(x, 1, duration_of(stretch));
  const Eigen::Vector3d &from = stretch.from.point, &to = stretch.to.point, along = to - from;
  PathPoint point{.position = from + s * along, .velocity = sd * along, .acceleration = sdd * along};
  // From the nearer end: both come out exact.
  const bool is_far = s > 0.5;
  if (is_far) point.position = to - (1 - s) * along;
  const Eigen::Vector3d& turn = stretch.turn;
  point.rotation = turn_by((is_far ? s - 1 : s) * turn) * (is_far ? stretch.to : stretch.from).rotation;
  point.spin = sd * turn;
  point.spin_rate = sdd * turn;
  return point;
}

PsiMotion Itinerary::motors_at(double step) const {
  const auto [stretch, x] = within(step);
  const auto [s, sd, sdd] = cycloid(x, 1, duration_of(stretch));
  const Vector &from = stretch.from.motors, &to = stretch.to.motors, along = to - from;
  return {s > 0.5 ? Vector(to - (1 - s) * along) : Vector(from + s * along), sd * along, sdd * along};
}

std::string Itinerary::to_text(const Eigen::Vector3d& point) const {
  std::string text;
  for (const int axis : axes_) text += fmt::format("{}{:.6g}", text.empty() ? "(" : ", ", point[axis]);
  return text + ")";
}

std::string Itinerary::to_text(const Path::Via& point) const {
  if (point.motors.size() == 0) return to_text(point.point);
  return "(" + joined("{:.6g}", span_of(point.motors)) + ")";
}

std::string Itinerary::describe(double step) const {
  const auto [stretch, x] = within(step);
  std::string lap;
  if (laps_ > 1)
    lap = fmt::format(", lap {} of {}", std::min(laps_, 1 + static_cast<std::int64_t>(step) / lap_steps()),
                      laps_);
  const char* unit = stretch.to.motors.size() > 0 ? " of the motors" : " m";
  if (stretch.is_rest()) return fmt::format("at rest at {}{}{}", to_text(stretch.from), unit, lap);
  Path::Via here = stretch.to;
  if (here.motors.size() > 0)
    here.motors = motors_at(step).psi;
  else
    here.point = at(step).position;
  return fmt::format("{:.4g} of the line from {} to {}{}, at {}{}{}", cycloid(x, 1, 1).s,
                     to_text(stretch.from), to_text(stretch.to), unit, to_text(here), unit, lap);
}

const Place& Itinerary::place(double step) const { return within(step).stretch.place; }

}  // namespace mixloop
