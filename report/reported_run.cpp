// SPDX-License-Identifier: MIT
#include "report/reported_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "dynamics/scene/load_scene.hpp"
#include "loop/inputs.hpp"
#include "report/mechanism.hpp"
#include "report/trajectory_reader.hpp"

namespace mixloop {
namespace {

using nlohmann::ordered_json;

ordered_json read_json(const std::filesystem::path& file) {
  std::ifstream in(file);
  auto json = ordered_json::parse(in, nullptr, false);
  if (!in || !json.is_object())
    throw InputError("not_a_result", {file.string()}, "is no JSON object; expected what --out keeps");
  return json;
}

bool is_there(const std::filesystem::path& file) {
  std::error_code failed;
  return std::filesystem::exists(file, failed);
}

/// What is known of the mechanism, from the kept inputs or an experiment that was named.
struct Known {
  ordered_json inputs;
  std::shared_ptr<const Scene> scene;
  std::vector<double> parameters;
  double rate_hz = 0;  ///< 0: not known
};

Known from_inputs(const std::filesystem::path& file) {
  Known known{.inputs = read_json(file)};
  const auto at = [&](const char* key) -> const ordered_json& {
    if (!known.inputs.contains(key))
      throw InputError("missing_key", {file.string()}, fmt::format("has no '{}'; expected what --out keeps", key));
    return known.inputs.at(key);
  };
  known.scene = std::make_shared<const Scene>(
      load_scene(parse_document(at("scene").dump(), file.string() + " (scene)")));
  known.parameters = known.scene->default_parameters();
  for (std::size_t i = 0; i < known.parameters.size(); ++i)
    known.parameters[i] = at("plant_parameters").value(known.scene->parameters[i].name, known.parameters[i]);
  known.rate_hz = at("rate").get<double>();
  return known;
}

Known known_of(const std::filesystem::path& folder, const ReadOptions& options) {
  if (options.experiment)
    return {.inputs = inputs_json(*options.experiment),
            .scene = options.experiment->scene,
            .parameters = options.experiment->plant_parameters,
            .rate_hz = options.experiment->rate_hz};
  if (is_there(folder / "inputs.json")) return from_inputs(folder / "inputs.json");
  return {};
}

LogSession chosen_session(const std::filesystem::path& log, const ReadOptions& options, std::int64_t wanted,
                          std::vector<std::string>& notes) {
  const auto sessions = sessions_in(log, options.prefix);
  const auto at = std::find_if(sessions.begin(), sessions.end(),
                               [&](const LogSession& s) { return wanted == 0 || s.session == wanted; });
  if (at == sessions.end()) {
    std::string list;
    for (const auto& session : sessions) list += fmt::format("{}{}", list.empty() ? "" : ", ", session.session);
    throw InputError("no_such_session", {log.string()}, fmt::format("no session {}; it has {}", wanted, list));
  }
  if (sessions.size() > 1)
    notes.push_back(fmt::format("The log has {} sessions; this is {}. Another: --session ID.", sessions.size(),
                                at->session));
  return *at;
}

void add_notes(const LogFacts& facts, std::vector<std::string>& notes) {
  const auto say = [&](std::int64_t count, const char* what) {
    if (count > 0) notes.push_back(fmt::format("{} {}", count, what));
  };
  say(facts.states_missing, "ticks have no STATE in the log: gaps.");
  say(facts.commands_missing, "ticks have no COMMAND in the log.");
  say(facts.references_missing, "ticks have no REFERENCE in the log.");
  say(facts.dropped, "messages of the run could not be read.");
  if (!facts.damage.empty()) notes.push_back("The log's file: " + facts.damage + ".");
}

ReportedRun read_folder(const std::filesystem::path& folder, const ReadOptions& options) {
  const Known known = known_of(folder, options);
  TrajectoryReader trajectory(folder / "trajectory.csv");
  const std::size_t m = known.scene ? static_cast<std::size_t>(known.scene->m()) : 0;
  std::optional<Mechanism> mechanism;
  if (known.scene) mechanism.emplace(known.scene, known.parameters);
  const auto axes = known.scene ? known.scene->end_effector.axes : std::vector<int>{0, 1, 2};
  auto result = read_json(folder / "result.json");
  const double rate = result.value("rate", known.rate_hz > 0 ? known.rate_hz : 1000.0);
  ReportedRun run{.label = result.value("experiment", folder.filename().string()),
                  .source = folder.string(),
                  .result = std::move(result),
                  .inputs = known.inputs,
                  .scene = known.scene,
                  .rate_hz = rate,
                  .n = trajectory.n(),
                  .m = m,
                  .curves = Curves(trajectory.n(), m, axes, rate, options.capacity)};
  if (known.scene && static_cast<std::size_t>(known.scene->n()) != run.n)
    throw InputError("wrong_size", {(folder / "trajectory.csv").string()},
                     fmt::format("{} motors; the scene has {}", run.n, known.scene->n()));

  std::vector<double> ages;
  const auto log = folder / "run.lcmlog";
  if (is_there(log)) {
    const auto session = chosen_session(log, options, run.result.value("session", options.session), run.notes);
    run.log = read_log(log, options.prefix, session, rate, 0, [&](const Tick& tick) {
      ages.resize(static_cast<std::size_t>(tick.k), kUnknown);
      ages.push_back(tick.command_age);
    });
    add_notes(*run.log, run.notes);
  }
  trajectory.read(m, [&](Tick& tick) {
    if (mechanism) mechanism->complete(tick);
    if (const auto k = static_cast<std::size_t>(tick.k); k < ages.size()) tick.command_age = ages[k];
    run.curves.add(tick);
  });
  if (!known.scene) run.notes.push_back("No inputs.json: dependent coordinates are not shown.");
  return run;
}

ReportedRun read_log_alone(const std::filesystem::path& log, const ReadOptions& options) {
  const Known known = known_of(log.parent_path(), options);
  std::vector<std::string> notes;
  const LogSession session = chosen_session(log, options, options.session, notes);
  const auto n = static_cast<std::size_t>(session.n);
  if (known.scene && known.scene->n() != session.n)
    throw InputError("wrong_size", {log.string()},
                     fmt::format("the log has {} motors, the scene {}", session.n, known.scene->n()));
  const std::size_t m = known.scene ? static_cast<std::size_t>(known.scene->m()) : 0;
  std::optional<Mechanism> mechanism;
  if (known.scene) mechanism.emplace(known.scene, known.parameters);
  const auto axes = known.scene ? known.scene->end_effector.axes : std::vector<int>{0, 1, 2};
  const double rate = known.rate_hz > 0 ? known.rate_hz : session.rate_hz;
  ReportedRun run{.label = known.inputs.is_object() ? known.inputs.value("name", log.stem().string())
                                                    : log.stem().string(),
                  .source = log.string(),
                  .from_log = true,
                  .inputs = known.inputs,
                  .scene = known.scene,
                  .rate_hz = rate,
                  .first_tick = session.first_tick,
                  .n = n,
                  .m = m,
                  .curves = Curves(n, m, axes, rate, options.capacity),
                  .notes = std::move(notes)};
  run.log = read_log(log, options.prefix, session, rate, m, [&](Tick& tick) {
    if (mechanism) mechanism->complete(tick);
    run.curves.add(tick);
  });
  add_notes(*run.log, run.notes);
  if (!run.log->has_truth && known.scene)
    run.notes.push_back(
        "The log has no TRUTH: the end effector's motion and the energies are worked out from the measured state and "
        "the commanded torque by the scene.");
  if (!run.log->has_truth && !known.scene)
    run.notes.push_back(
        "The log has no TRUTH and no inputs.json beside it: without the scene (--experiment FILE) there is no actual "
        "motion of the end effector.");
  return run;
}

}  // namespace

ReportedRun read_run(const std::filesystem::path& path, const ReadOptions& options) {
  std::error_code failed;
  if (!std::filesystem::is_directory(path, failed)) return read_log_alone(path, options);
  if (is_there(path / "trajectory.csv") && is_there(path / "result.json")) return read_folder(path, options);
  if (is_there(path / "run.lcmlog")) return read_log_alone(path / "run.lcmlog", options);
  throw InputError("not_a_result", {path.string()},
                   "no result.json with a trajectory.csv and no run.lcmlog in it; expected a folder that "
                   "`mixloop simulate` or `run` kept by --out");
}

}  // namespace mixloop
