// SPDX-License-Identifier: MIT
#include "watch/watch_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "notation/number_text.hpp"

namespace mixloop {
namespace {

std::string duration_text(double seconds) {
  const double s = std::abs(seconds);
  if (s < 1e-3) return fmt::format("{:.0f} us", seconds * 1e6);
  if (s < 1) return fmt::format("{:.3g} ms", seconds * 1e3);
  if (s < 120) return fmt::format("{:.1f} s", seconds);
  return fmt::format("{:.0f} min", seconds / 60);
}
std::string duration_text(nanoseconds time) {
  return duration_text(std::chrono::duration<double>(time).count());
}
std::string duration_text_ns(std::int64_t ns) { return duration_text(nanoseconds(ns)); }

/// Of TIMING, which says 0 for none.
std::string quantile_text(std::int64_t ns) { return ns == 0 ? "-" : duration_text_ns(ns); }

std::string number_text(bool known, double value, int digits) { return known ? fixed(value, digits) : "-"; }

Piece count_piece(std::uint64_t count, int width) {
  return {fmt::format("{:>{}}", count, width), count > 0 ? Style::warning : Style::plain};
}

Line title(const WatchView& view) {
  return {{"mixloop", Style::heading},
          {view.session == 0 ? std::string()
                             : fmt::format("  session {}  tick {}  {:.3f} s  {}", view.session, view.tick,
                                           view.plant_time, view.real_time ? "real time" : "lockstep")}};
}

Piece condition(const WatchView& view) {
  const auto age = view.channels[static_cast<std::size_t>(Channel::state)].age;
  switch (view.condition) {
    case Condition::silent:
      return {age ? "no STATE for " + duration_text(*age)
                  : "nothing heard of a plant yet: is this the plant's network namespace?",
              Style::warning};
    case Condition::ended:
      return {"ended: " + ending_text(view), view.ending == Ending::finished ? Style::good : Style::warning};
    case Condition::stopped:
      return {"STOPPED", Style::warning};
    case Condition::safe_state:
      return {"SAFE STATE: the plant ignores commands until a reset", Style::warning};
    case Condition::holding:
      return {"holding the end of the path", Style::good};
    case Condition::moving_to_start:
      return {"moving to the path's start", Style::good};
    case Condition::waiting:
      return {fmt::format("waiting: no COMMAND that answers tick {}", view.tick), Style::warning};
    case Condition::paused:
      return {fmt::format("paused: the plant repeats tick {}", view.tick), Style::warning};
    case Condition::moving:
      return {"moving, without a path", Style::good};
    case Condition::on_path:
      break;
  }
  return {"on the path", Style::good};
}

Line status(const WatchView& view) {
  Line line = {condition(view)};
  for (const std::string& warning : view.warnings) line.push_back({"; ! " + warning, Style::warning});
  if (view.other_sessions > 0)
    line.push_back({fmt::format("; ! {} messages of other runs", view.other_sessions), Style::warning});
  return line;
}

void add_channels(std::vector<Line>& lines, const WatchView& view, bool whole) {
  lines.push_back({{fmt::format("{:<24} {:>9} {:>9} {:>11} {:>7} {:>8} {:>6}", "channel", "rate, Hz", "age",
                                "messages", "lost", "repeated", "bad"),
                    Style::heading}});
  std::string unheard;
  for (const ChannelView& channel : view.channels) {
    if (channel.received == 0) {
      unheard += (unheard.empty() ? "" : " ") + channel.name;
      continue;
    }
    lines.push_back(
        {{fmt::format("{:<24} {:>9.1f} {:>9} {:>11} ", whole ? channel.name : channel.name.substr(0, 24),
                      channel.rate_hz, duration_text(*channel.age), channel.received)},
         channel.lost ? count_piece(*channel.lost, 7) : Piece{"      -"},
         {fmt::format(" {:>8} ", channel.repeated)},
         count_piece(channel.bad, 6)});
  }
  if (!unheard.empty()) lines.push_back({{"not heard: " + unheard, Style::quiet}});
}

Line tracking(const WatchView& view) {
  if (view.condition == Condition::moving)
    return {{"position error  ", Style::heading}, {"none: it moves without a path", Style::quiet}};
  if (!view.position_error)
    return {{"position error  ", Style::heading},
            {"none yet: it needs the path, and TRUTH on the bus or an experiment", Style::quiet}};
  return {{"position error  ", Style::heading},
          {fmt::format("now {}  worst {} mm at {:.3f} s, by the {}", fixed(1e3 * view.position_error->now, 4),
                       fixed(1e3 * view.position_error->worst, 4), view.worst_at, view.position_source)}};
}

// From -limit to limit, zero in the middle; past the limit it ends in an arrow.
std::string bar(double value, double limit, std::size_t half) {
  std::string left(half, ' '), right(half, ' ');
  const double part = limit > 0 ? std::abs(value) / limit : 0;
  const auto filled = static_cast<std::size_t>(std::lround(std::min(part, 1.0) * static_cast<double>(half)));
  std::string& side = value < 0 ? left : right;
  for (std::size_t i = 0; i < filled; ++i) side[value < 0 ? half - 1 - i : i] = '=';
  if (part > 1) side[value < 0 ? 0 : half - 1] = value < 0 ? '<' : '>';
  return "[" + left + "|" + right + "]";
}

Line motor_line(std::size_t i, const MotorView& motor, std::size_t half) {
  const Extreme &error = motor.error, &torque = motor.torque;
  const bool over = motor.limit && std::abs(motor.torque.now) > *motor.limit;
  const std::string unit = motor.torque_unit.empty() ? "" : fmt::format("{:<4}", motor.torque_unit);
  return {{fmt::format(
              "{:<5} {:>10} {:>10} {:>9} {:>9} {:>8} {}", i + 1, number_text(error.now_known, error.now, 6),
              number_text(error.worst_known, error.worst, 6), number_text(torque.now_known, torque.now, 4),
              number_text(torque.worst_known, torque.worst, 4),
              motor.limit ? fmt::format("{:.4g}", *motor.limit) : "-", unit)},
          {bar(motor.torque.now, motor.limit.value_or(std::abs(motor.torque.worst)), half),
           over ? Style::warning : Style::plain}};
}

void add_motors(std::vector<Line>& lines, const WatchView& view, std::size_t width, std::size_t room) {
  if (view.motors.empty() || room < 2) return;
  const bool units = !view.motors.front().torque_unit.empty();
  const std::size_t columns = units ? 61 : 57,
                    half = std::clamp<std::size_t>((width - std::min(width, columns + 3)) / 2, 5, 40);
  const bool limits = view.motors.front().limit.has_value();
  lines.push_back({{fmt::format("{:<5} {:>10} {:>10} {:>9} {:>9} {:>8} {:<{}} {}", "motor", "error now",
                                "worst", "torque", "worst", "limit", units ? "unit" : "", units ? 4 : 0,
                                limits ? "torque to its limit" : "torque to its worst"),
                    Style::heading}});
  const std::size_t n = view.motors.size(), shown = n <= room - 1 ? n : room - 2;
  for (std::size_t i = 0; i < shown; ++i) lines.push_back(motor_line(i, view.motors[i], half));
  if (shown < n)
    lines.push_back(
        {{fmt::format("... and {} more: a taller terminal shows them", n - shown), Style::quiet}});
}

Line times(const char* what, const std::string& p50, const std::string& p99, const std::string& max) {
  return {{fmt::format("{:<24} {:>9} {:>9} {:>9}", what, p50, p99, max)}};
}

std::int64_t rejected(const timing_t& timing) {
  std::int64_t all = 0;
  for (const RejectRow& row : kRejects) all += timed(timing, row);
  return all;
}

std::vector<Line> timing_lines(const WatchView& view) {
  std::vector<Line> lines;
  lines.push_back({{fmt::format("{:<24} {:>9} {:>9} {:>9}", "timing", "p50", "p99", "max"), Style::heading}});
  if (const auto& t = view.timing) {
    lines.push_back(times("plant: round trip", quantile_text(t->round_trip_p50),
                          quantile_text(t->round_trip_p99), quantile_text(t->round_trip_max)));
    lines.push_back(times("plant: wake-up", quantile_text(t->wake_up_p50), quantile_text(t->wake_up_p99),
                          quantile_text(t->wake_up_max)));
    lines.push_back({{fmt::format("missed {} (in a row {}), in time {:.0f} % of the last 100, dropped {}",
                                  t->missed, t->longest_miss, 100 * t->success_last_100, rejected(*t)),
                      t->missed > 0 ? Style::warning : Style::plain}});
    const std::string dropped = dropped_in(*t);
    lines.push_back(
        {{fmt::format("overruns {}, slipped {}, resent {}{}{}", t->overruns, duration_text_ns(t->slipped),
                      t->resent, dropped.empty() ? "" : "; dropped: ", dropped),
          t->overruns > 0 ? Style::warning : Style::plain}});
  } else {
    lines.push_back({{"no TIMING heard yet from the plant", Style::quiet}});
  }
  const auto add_heard = [&lines](const char* what, const Heard& heard) {
    if (heard.count > 0)
      lines.push_back(
          times(what, duration_text(heard.p50), duration_text(heard.p99), duration_text(heard.max)));
  };
  add_heard("here: state to state", view.state_interval);
  add_heard("here: state to command", view.command_after_state);
  return lines;
}

void cut(std::vector<Line>& lines, std::size_t width, std::size_t height) {
  if (lines.size() > height) lines.resize(height);
  for (Line& line : lines) {
    std::size_t left = width;
    for (Piece& piece : line) {
      if (piece.text.size() > left) piece.text.resize(left);
      left -= piece.text.size();
    }
  }
}

}  // namespace

std::string ending_text(const WatchView& view) {
  if (!view.ending) return "";
  return view.ending == Ending::broken_off ? "fault" : std::string(name(*view.ending));
}

std::string to_text(const Line& line) {
  std::string text;
  for (const Piece& piece : line) text += piece.text;
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

namespace {

std::vector<Line> laid_out(const WatchView& view, std::size_t width, std::size_t height, bool whole) {
  std::vector<Line> lines = {title(view), status(view)};
  add_channels(lines, view, whole);
  const std::vector<Line> below = timing_lines(view);
  // Blank lines are the first to go, then motors, then the last lines.
  const std::size_t needed =
      lines.size() + 1 + (view.motors.empty() ? 0 : 1 + view.motors.size()) + below.size();
  const bool airy = needed + 2 <= height;
  if (airy) lines.emplace_back();
  lines.push_back(tracking(view));
  const std::size_t taken = lines.size() + below.size() + (airy ? 1 : 0);
  add_motors(lines, view, width, height > taken ? height - taken : 0);
  if (airy) lines.emplace_back();
  lines.insert(lines.end(), below.begin(), below.end());
  return lines;
}

}  // namespace

std::vector<Line> watch_lines(const WatchView& view, std::size_t width, std::size_t height) {
  std::vector<Line> lines = laid_out(view, width, height, false);
  cut(lines, width, height);
  return lines;
}

std::vector<Line> whole_watch_lines(const WatchView& view) {
  return laid_out(view, 80, std::numeric_limits<std::size_t>::max() / 2, true);
}

}  // namespace mixloop
