// SPDX-License-Identifier: MIT
#include "report/run_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

#include "dynamics/assembly/load_scene.hpp"
#include "loop/arrivals_file.hpp"
#include "loop/inputs.hpp"
#include "loop/kept_files.hpp"
#include "loop/kept_json.hpp"
#include "notation/sha256.hpp"
#include "notation/utf8.hpp"
#include "report/mechanism.hpp"
#include "report/trajectory_reader.hpp"
#include "runtime/bus/rejects.hpp"

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

constexpr auto kReplace = ordered_json::error_handler_t::replace;

double rate_in(const std::filesystem::path& file, double rate) {
  if (rate > 0 && std::isfinite(rate)) return rate;
  throw InputError("out_of_range", {file.string()},
                   fmt::format("its 'rate' is {}; expected more than 0 Hz", rate));
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
  const KeptJson kept(known.inputs, file);
  const std::string scene = kept.value<ordered_json>("scene").dump(-1, ' ', false, kReplace);
  known.scene = std::make_shared<const Scene>(load_scene(parse_document(scene, file.string() + " (scene)")));
  known.parameters = known.scene->default_parameters();
  const auto values = kept.value<std::map<std::string, double>>("plant_parameters");
  for (std::size_t i = 0; i < known.parameters.size(); ++i)
    if (const auto value = values.find(known.scene->parameters[i].name); value != values.end())
      known.parameters[i] = value->second;
  known.rate_hz = rate_in(file, kept.value<double>("rate"));
  // What a page draws of the rest.
  kept.value<std::string>("name", "");
  kept.value<std::map<std::string, ordered_json>>("limits", {});
  using Entries = std::map<std::string, ordered_json>;
  for (const Entries& fault : kept.value<std::vector<Entries>>("faults", {})) {
    const ordered_json entries(fault);
    const KeptJson one(entries, file);
    one.value<std::string>("text", "");
    one.value<double>("at", 0);
    one.value<double>("until", 0);
  }
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

LogSession chosen_session(const std::filesystem::path& log, const std::vector<LogSession>& sessions,
                          std::int64_t wanted, std::vector<std::string>& notes) {
  const auto at = std::find_if(sessions.begin(), sessions.end(),
                               [&](const LogSession& s) { return wanted == 0 || s.session == wanted; });
  if (at == sessions.end()) {
    std::string list;
    for (const auto& session : sessions)
      list += fmt::format("{}{}", list.empty() ? "" : ", ", session.session);
    throw InputError("no_such_session", {log.string()},
                     fmt::format("no session {}; it has {}", wanted, list));
  }
  if (sessions.size() > 1)
    notes.push_back(fmt::format("The log has {} sessions; this is {}. Another: --session ID.",
                                sessions.size(), at->session));
  return *at;
}

/// As foreign_file; where the result doesn't tell, by the scene that it was of.
std::string foreign_inputs(const ordered_json& result, const std::filesystem::path& file,
                           const Scene& scene) {
  if (result.contains("files")) return foreign_file(result, file);
  if (!result.contains("scene_sha256") || result["scene_sha256"] == sha256_hex(scene.canonical)) return "";
  return "inputs.json has another scene than result.json beside it: it is of another run.";
}

/// Without a path there are no references to miss.
void add_notes(LogFacts& facts, RunFile& run) {
  auto& notes = run.notes;
  const auto say = [&](std::int64_t count, const char* what) {
    if (count > 0) notes.push_back(fmt::format("{} {}", count, what));
  };
  if (!run.has_path) facts.references_missing = 0;
  say(facts.states_missing, "ticks have no STATE in the log: gaps.");
  say(facts.commands_missing, "ticks have no COMMAND in the log.");
  say(facts.references_missing, "ticks have no REFERENCE in the log.");
  say(facts.dropped, "messages of the run could not be read, or are of no tick that the log has.");
  if (!facts.damage.empty()) notes.push_back("The log's file: " + facts.damage + ".");
}

/// Why a run ended early, and what its plant could not take; doubled messages alone are a lossy network's.
void add_what_went_wrong(const KeptJson& result, std::vector<std::string>& notes) {
  const auto error = result.value<std::map<std::string, std::string>>("error", {});
  if (const auto message = error.find("message"); message != error.end())
    notes.push_back("The run ended by a fault: " + message->second + ".");
  const auto by_cause = result.value<std::map<std::string, std::int64_t>>("rejected_by_cause", {});
  std::string dropped;
  for (const auto& [cause, count] : by_cause)
    if (count > 0 && cause != "stale")
      dropped += fmt::format("{}{} {}", dropped.empty() ? "" : ", ", count, cause);
  if (!dropped.empty()) notes.push_back("The plant dropped messages: " + dropped + ".");
}

/// The log beside a result, where it is of the same run.
void take_log(RunFile& run, const std::filesystem::path& log, const ReadOptions& options) {
  const std::filesystem::path result_file = log.parent_path() / "result.json";
  const auto sessions = sessions_in(log, options.prefix);
  std::set<std::int64_t> ids;
  for (const auto& session : sessions) ids.insert(session.session);
  if (const std::string why = foreign_log(run.result, log, ids); !why.empty()) {
    run.notes.push_back(why + " It is left out.");
    return;
  }
  run.log = log;
  run.session = chosen_session(
      log, sessions, KeptJson(run.result, result_file).value<std::int64_t>("session", options.session),
      run.notes);
}

/// What is known before the ticks: of a folder, then of a log.
RunFile opened_folder(const std::filesystem::path& folder, const ReadOptions& options, Known& known) {
  RunFile run{.label = printable_name(folder.filename().string()),
              .source = printable_name(folder.string()),
              .trajectory = folder / "trajectory.csv"};
  run.sizes = TrajectoryReader(run.trajectory).sizes();
  run.result = read_json(folder / "result.json");
  const KeptJson result(run.result, folder / "result.json");
  run.label = result.value("experiment", run.label);
  run.rate_hz =
      rate_in(folder / "result.json", result.value("rate", known.rate_hz > 0 ? known.rate_hz : 1000.0));
  if (!options.experiment && known.scene)
    if (const std::string why = foreign_inputs(run.result, folder / "inputs.json", *known.scene);
        !why.empty()) {
      run.notes.push_back(why + " It is left out.");
      known = {};
    }
  if (const std::string why = foreign_file(run.result, run.trajectory); !why.empty())
    run.notes.push_back(why);
  if (const auto log = folder / "run.lcmlog"; is_there(log)) take_log(run, log, options);
  if (const auto ages = folder / "ages.csv"; is_there(ages)) {
    const std::string why = foreign_file(run.result, ages);
    if (why.empty())
      run.ages = ages;
    else
      run.notes.push_back(why + " It is left out.");
  }
  if (!known.scene) run.notes.push_back("No inputs.json: dependent coordinates are not shown.");
  add_what_went_wrong(result, run.notes);
  return run;
}

RunFile opened_log(const std::filesystem::path& log, const ReadOptions& options, const Known& known) {
  RunFile run{.label = printable_name(log.stem().string()),
              .source = printable_name(log.string()),
              .from_log = true,
              .log = log};
  const auto sessions = sessions_in(log, options.prefix);
  run.session = chosen_session(log, sessions, options.session, run.notes);
  run.sizes.n = known.scene ? known.scene->independent.size()
                            : static_cast<std::size_t>(std::max(run.session->n, run.session->n_all));
  const auto commanded = static_cast<std::size_t>(run.session->n_u);
  run.sizes.n_u = known.scene                                 ? known.scene->motors().size()
                  : commanded > 0 && commanded <= run.sizes.n ? commanded
                                                              : run.sizes.n;
  run.first_tick = run.session->first_tick;
  if (known.inputs.is_object()) run.label = known.inputs.value("name", run.label);
  run.rate_hz = known.rate_hz > 0 ? known.rate_hz : run.session->rate_hz;
  return run;
}

/// A list or value among kept inputs; null where there is none.
const nlohmann::ordered_json* entry_of(const nlohmann::ordered_json& inputs,
                                       std::initializer_list<const char*> keys) {
  const auto* entry = &inputs;
  for (const char* key : keys) {
    if (!entry->is_object() || !entry->contains(key)) return nullptr;
    entry = &(*entry)[key];
  }
  return entry;
}

/// Whether the plant of kept inputs switches coordinates.
bool switches(const nlohmann::ordered_json& inputs) {
  const auto* said = entry_of(inputs, {"experiment", "plant", "near_singular"});
  return said && *said == "switch";
}

/// Which independent coordinates the plant of kept inputs measures.
std::vector<int> measured(const nlohmann::ordered_json& inputs, const Scene& scene) {
  const auto* free = entry_of(inputs, {"experiment", "plant", "sensors", "free"});
  std::vector<int> all;
  for (int i = 0; i < scene.n(); ++i) {
    const auto& coordinate = scene.independent[static_cast<std::size_t>(i)];
    const auto is_named = [&] {
      return free->is_array() ? std::find(free->begin(), free->end(), coordinate.name) != free->end()
                              : *free == coordinate.name;
    };
    if (coordinate.driven || !free || is_named()) all.push_back(i);
  }
  return all;
}

/// A run in real time kept when each command arrived, on the plant's own clock: better than a logger's.
void take_arrivals(const std::filesystem::path& file, double rate_hz, std::vector<double>& ages) {
  constexpr std::int64_t kLongest = 100'000'000;  // ticks: a damaged number must not take all memory
  const Arrivals arrivals = read_arrivals(file);
  for (const Arrival& arrival : arrivals.commands) {
    if (arrival.command >= kLongest) break;
    const auto k = static_cast<std::size_t>(arrival.command);
    if (k >= ages.size()) ages.resize(k + 1, kUnknown);
    ages[k] = static_cast<double>(arrival.tick - arrival.command) / rate_hz +
              static_cast<double>(arrival.offset) * 1e-9;
  }
}

std::optional<LogFacts> read_folder(RunFile& run, Mechanism* mechanism,
                                    const std::function<void(Tick&)>& on_tick) {
  std::optional<LogFacts> facts;
  std::vector<double> ages;
  if (run.session) {
    facts = read_log(run.log, run.prefix, *run.session, run.rate_hz, run.sizes, [&](const Tick& tick) {
      ages.resize(static_cast<std::size_t>(tick.k), kUnknown);
      ages.push_back(tick.command_age);
    });
    add_notes(*facts, run);
  }
  if (!run.ages.empty()) {
    ages.clear();
    take_arrivals(run.ages, run.rate_hz, ages);
    run.notes.push_back("The ages of commands are the plant's own (ages.csv).");
  }
  TrajectoryReader(run.trajectory).read(run.sizes.m, [&](Tick& tick) {
    if (mechanism) mechanism->complete(tick);
    if (const auto k = static_cast<std::size_t>(tick.k); k < ages.size()) tick.command_age = ages[k];
    on_tick(tick);
  });
  return facts;
}

LogFacts read_log_alone(RunFile& run, Mechanism* mechanism, const std::function<void(Tick&)>& on_tick) {
  LogFacts facts = read_log(run.log, run.prefix, *run.session, run.rate_hz, run.sizes, [&](Tick& tick) {
    if (mechanism) mechanism->complete(tick);
    on_tick(tick);
  });
  add_notes(facts, run);
  if (const std::string dropped = facts.timing.empty() ? "" : dropped_in(facts.timing.back());
      !dropped.empty())
    run.notes.push_back("By its TIMING the plant dropped messages: " + dropped + ".");
  if (!facts.has_truth && run.scene && run.session->measured.size() < run.sizes.n)
    run.notes.push_back(
        "The log has no TRUTH, and not all free coordinates are measured: how the mechanism stands isn't "
        "known.");
  else if (!facts.has_truth && run.scene)
    run.notes.push_back(
        "The log has no TRUTH: the end effector's motion and the energies are worked out from the measured "
        "state and "
        "the commanded torque by the scene.");
  if (!facts.has_truth && !run.scene)
    run.notes.push_back(
        "The log has no TRUTH and no inputs.json beside it: without the scene (--experiment FILE) there is "
        "no actual "
        "motion of the end effector.");
  return facts;
}

}  // namespace

RunFile open_run(const std::filesystem::path& path, const ReadOptions& options) {
  std::error_code failed;
  const bool is_folder = std::filesystem::is_directory(path, failed);
  const bool is_result = is_folder && is_there(path / "trajectory.csv") && is_there(path / "result.json");
  if (is_folder && !is_result && !is_there(path / "run.lcmlog"))
    throw InputError("not_a_result", {path.string()},
                     "no result.json with a trajectory.csv and no run.lcmlog in it; expected a folder that "
                     "`mixloop simulate` or `run` kept by --out");
  const std::filesystem::path log = is_folder ? path / "run.lcmlog" : path;
  Known known = known_of(log.parent_path(), options);
  RunFile run = is_result ? opened_folder(path, options, known) : opened_log(log, options, known);
  run.prefix = options.prefix;
  run.inputs = known.inputs;
  if (run.inputs.is_object() && run.inputs.contains("experiment"))
    run.has_path = !run.inputs["experiment"].is_object() || !run.inputs["experiment"].contains("duration");
  run.switches = switches(run.inputs);
  run.scene = known.scene;
  run.parameters = known.parameters;
  if (!run.scene) return run;
  const auto require_as_many = [&](const char* what, std::size_t has, std::size_t should,
                                   const char* says = "the scene has") {
    if (has != should)
      throw InputError("wrong_size", {run.source}, fmt::format("{} {}; {} {}", has, what, says, should));
  };
  require_as_many("motors", run.sizes.n_u, run.scene->motors().size());
  require_as_many("independent coordinates", run.sizes.n, run.scene->independent.size());
  if (run.session) {
    run.session->measured = measured(run.inputs, *run.scene);
    require_as_many("measured coordinates", static_cast<std::size_t>(run.session->n),
                    run.session->measured.size(), "the experiment measures");
  }
  run.sizes.m = run.scene->coordinates.size();
  return run;
}

std::optional<LogFacts> read_ticks(RunFile& run, const std::function<void(Tick&)>& on_tick) {
  std::optional<Mechanism> mechanism;
  if (run.switches)
    run.notes.push_back(
        "The plant switched coordinates (near_singular): the motors' alone don't say how the other ones "
        "stand, "
        "which are left out.");
  else if (run.scene)
    mechanism.emplace(run.scene, run.parameters);
  Mechanism* known = mechanism ? &*mechanism : nullptr;
  if (run.from_log) return read_log_alone(run, known, on_tick);
  return read_folder(run, known, on_tick);
}

}  // namespace mixloop
