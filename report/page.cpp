// SPDX-License-Identifier: MIT
#include "report/page.hpp"

#include <cmath>

#include "report/packed.hpp"

namespace mixloop {
namespace {

using nlohmann::ordered_json;

constexpr std::string_view kPlace = R"(<script id="mixloop-data" type="application/json">null</script>)";

ordered_json error_json(const TrackingError& error) {
  return {{"max", number_or_null(error.max)},
          {"time_of_max", number_or_null(error.time_of_max)},
          {"final", number_or_null(error.final)},
          {"rms", number_or_null(error.rms)}};
}

ordered_json names_json(const ReportedRun& run) {
  auto motors = ordered_json::array(), coordinates = ordered_json::array();
  for (std::size_t i = 0; i < run.sizes.n_u; ++i)
    motors.push_back({{"name", run.scene ? run.scene->motors()[i].name : "psi" + std::to_string(i + 1)},
                      {"linear", run.scene && run.scene->motors()[i].linear}});
  for (std::size_t j = 0; j < run.sizes.m; ++j) {
    bool linear = false;
    for (const auto& transform : run.scene->transforms)
      linear |= transform.coordinate == static_cast<int>(j) && transform.prismatic;
    coordinates.push_back({{"name", run.scene->coordinates[j].name}, {"linear", linear}});
  }
  ordered_json names = {{"motors", motors}, {"coordinates", coordinates}};
  for (std::size_t i = run.sizes.n_u; i < run.sizes.n; ++i)
    names["free"].push_back(
        {{"name", run.scene ? run.scene->independent[i].name : "psi" + std::to_string(i + 1)},
         {"linear", run.scene && run.scene->independent[i].linear}});
  return names;
}

// TIMING's times in seconds; its counts are numbers like all others of the row.
ordered_json timing_row(const timing_t& m, double rate_hz) {
  const auto number = [](std::int64_t count) { return static_cast<double>(count); };
  const auto s = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-9; };
  return {number(m.seq) / rate_hz, s(m.round_trip_p50), s(m.round_trip_p99), s(m.round_trip_max),
          s(m.wake_up_p50),        s(m.wake_up_p99),    s(m.wake_up_max),    number(m.missed),
          number(m.resent),        number(m.overruns)};
}

ordered_json log_json(const LogFacts& facts, double rate_hz) {
  ordered_json rows = ordered_json::array();
  for (const timing_t& timing : facts.timing) rows.push_back(timing_row(timing, rate_hz));
  return {{"states_missing", facts.states_missing},
          {"commands_missing", facts.commands_missing},
          {"references_missing", facts.references_missing},
          {"dropped", facts.dropped},
          {"real_time", facts.is_real_time},
          {"safe_state", facts.reached_safe_state},
          {"truth", facts.has_truth},
          {"timing", rows}};
}

// Those of the experiment and, by the log, those that an operator ordered.
ordered_json faults_json(const ReportedRun& run) {
  auto faults = ordered_json::array();
  if (run.inputs.is_object() && run.inputs.contains("faults")) faults = run.inputs["faults"];
  if (!run.facts || !run.scene) return faults;
  for (const auto& [tick, fault] : run.facts->faults) {
    faults.push_back({{"text", to_string(fault, *run.scene) + ", by message"}, {"at", fault.at}});
    if (fault.duration > 0) faults.back()["until"] = fault.at + fault.duration;
  }
  return faults;
}

// It has more digits than a script's number holds.
ordered_json with_session_as_text(ordered_json result) {
  if (result.is_object() && result.contains("session") && result["session"].is_number_integer())
    result["session"] = std::to_string(result["session"].get<std::int64_t>());
  return result;
}

}  // namespace

ordered_json number_or_null(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json();
}

std::string with_data(const std::string& page, const ordered_json& data) {
  const std::size_t at = page.find(kPlace);
  if (at == std::string::npos)
    throw RunFault("missing_part", "the page has no place for its data; build it again (web/)");
  // Bad UTF-8 of a stranger's is replaced; '<' may end a script.
  std::string text = data.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  for (std::size_t i = text.find('<'); i != std::string::npos; i = text.find('<', i))
    text.replace(i, 1, "\\u003c");
  const std::size_t null = at + kPlace.find("null");
  return page.substr(0, null) + text + page.substr(null + 4);
}

ordered_json page_data(const std::vector<ReportedRun>& runs) {
  ordered_json list = ordered_json::array();
  std::vector<float> values;
  for (const auto& run : runs) {
    ordered_json json = {{"label", run.label},
                         {"source", run.source},
                         {"from_log", run.from_log},
                         {"rate", run.rate_hz},
                         {"first_tick", run.first_tick},
                         {"ticks", run.curves.ticks()},
                         {"width", run.curves.width()},
                         {"error", error_json(run.curves.tracking_error())},
                         {"names", names_json(run)},
                         {"notes", run.notes},
                         {"result", with_session_as_text(run.result)},
                         {"inputs", run.inputs},
                         {"log", run.facts ? log_json(*run.facts, run.rate_hz) : ordered_json()},
                         {"faults", faults_json(run)},
                         {"curves", ordered_json::object()}};
    for (const auto& curve : run.curves.all()) {
      if (curve.envelope.empty()) continue;
      const auto points = curve.envelope.points();
      json["length"] = points.size();
      json["curves"][curve.name] = values.size();
      values.insert(values.end(), points.begin(), points.end());
    }
    list.push_back(std::move(json));
  }
  return {
      {"mixloop", MIXLOOP_VERSION}, {"runs", list}, {"values", values.size()}, {"curves", packed(values)}};
}

std::string report_page(const std::string& page, std::vector<ReportedRun>& runs, std::size_t most_bytes) {
  for (;;) {
    std::string text = with_data(page, page_data(runs));
    if (text.size() <= most_bytes) return text;
    bool coarsened = false;
    for (auto& run : runs) {
      if (run.curves.ticks() / run.curves.width() < 64) continue;
      run.curves.coarsen();
      coarsened = true;
    }
    if (!coarsened) return text;  // it is not the curves that are long
  }
}

}  // namespace mixloop
