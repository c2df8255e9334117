// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <functional>

#include "watch/watch_text.hpp"

namespace mixloop {
namespace {

double seconds(nanoseconds time) { return std::chrono::duration<double>(time).count(); }

nlohmann::json heard_json(const Heard& heard) {
  if (heard.count == 0) return {{"count", 0}, {"p50", nullptr}, {"p99", nullptr}, {"max", nullptr}};
  return {{"count", heard.count},
          {"p50", seconds(heard.p50)},
          {"p99", seconds(heard.p99)},
          {"max", seconds(heard.max)}};
}

template <class Value>
nlohmann::json or_null(const std::optional<Value>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

nlohmann::json channels_json(const WatchView& view) {
  auto channels = nlohmann::json::object();
  for (const ChannelView& c : view.channels)
    channels[c.name] = {{"received", c.received},  {"rate", c.rate_hz},      {"age", or_null(c.age)},
                        {"lost", or_null(c.lost)}, {"repeated", c.repeated}, {"bad", c.bad}};
  return channels;
}

nlohmann::json now(const Extreme& of) { return of.now_known ? nlohmann::json(of.now) : nlohmann::json(); }
nlohmann::json worst(const Extreme& of) {
  return of.worst_known ? nlohmann::json(std::abs(of.worst)) : nlohmann::json();
}

// A value a motor; null where there are none.
nlohmann::json by_motor(const WatchView& view, const std::function<nlohmann::json(const MotorView&)>& value) {
  auto all = nlohmann::json::array();
  for (const MotorView& motor : view.motors) all.push_back(value(motor));
  const bool none =
      all.empty() || std::all_of(all.begin(), all.end(), [](const auto& one) { return one.is_null(); });
  return none ? nlohmann::json() : all;
}

// The message's own names, times in seconds; null where it says 0 for none.
nlohmann::json timing_json(const timing_t& timing) {
  nlohmann::json json;
  visit_fields(timing, [&json](const char* name, std::string_view said, const auto& value) {
    if (said.starts_with("ns"))
      json[name] = 1e-9 * static_cast<double>(value);
    else
      json[name] = value;
  });
  for (const char* times : {"round_trip", "wake_up"})
    for (const char* which : {"_p50", "_p99", "_max"})
      if (auto& time = json[std::string(times) + which]; time == 0) time = nullptr;
  for (const char* header : {"n", "utime", "seq", "session", "config"}) json.erase(header);
  return json;
}

}  // namespace

nlohmann::json watch_json(const WatchView& view) {
  const auto& position = view.position_error;
  return {{"channels", channels_json(view)},
          {"session", view.session},
          {"other_sessions", view.other_sessions},
          {"tick", view.tick},
          {"plant_time", view.plant_time},
          {"mode", view.real_time ? "real_time" : "lockstep"},
          {"condition", kConditionNames[static_cast<std::size_t>(view.condition)]},
          {"ending", ending_text(view)},
          {"warnings", view.warnings},
          {"position_error", position ? nlohmann::json(position->now) : nlohmann::json()},
          {"max_position_error", position ? nlohmann::json(position->worst) : nlohmann::json()},
          {"time_of_max_position_error", position ? nlohmann::json(view.worst_at) : nlohmann::json()},
          {"position_source", view.position_source},
          {"motor_error", by_motor(view, [](const MotorView& m) { return now(m.error); })},
          {"max_motor_error", by_motor(view, [](const MotorView& m) { return worst(m.error); })},
          {"torque", by_motor(view, [](const MotorView& m) { return now(m.torque); })},
          {"max_torque", by_motor(view, [](const MotorView& m) { return worst(m.torque); })},
          {"applied_torque", by_motor(view, [](const MotorView& m) { return or_null(m.applied); })},
          {"torque_unit", by_motor(view,
                                   [](const MotorView& m) {
                                     return m.torque_unit.empty() ? nlohmann::json()
                                                                  : nlohmann::json(m.torque_unit);
                                   })},
          {"torque_limit", by_motor(view, [](const MotorView& m) { return or_null(m.limit); })},
          {"timing", view.timing ? timing_json(*view.timing) : nlohmann::json()},
          {"state_interval", heard_json(view.state_interval)},
          {"command_after_state", heard_json(view.command_after_state)}};
}

}  // namespace mixloop
