// SPDX-License-Identifier: MIT
#include "commands/studies/tuned.hpp"

#include <fmt/format.h>

#include <cmath>

#include "loop/result.hpp"
#include "notation/utf8.hpp"
#include "processes/called_as.hpp"
#include "report/page.hpp"

namespace mixloop {
namespace {

std::string sign_of(const Bound& bound) {
  return std::string(bound.is_upper ? "<" : ">") + (bound.is_strict ? "" : "=");
}

std::string labelled(const Criteria::Criterion& criterion) {
  return criterion.unit == "1" ? criterion.name : fmt::format("{} [{}]", criterion.name, criterion.unit);
}

std::string number(double value) {
  if (std::isnan(value)) return "-";
  return std::isinf(value) ? "no limit" : fmt::format("{:.9g}", value);
}

/// What isn't there in a run is worse than any number.
std::string number_of_runs(double value, const Criteria::Criterion& criterion, const Assessment& assessment) {
  if (std::isinf(value) && !criterion.margin) return assessment.failed > 0 ? "runs fail" : "never";
  return number(value);
}

std::string row(const std::string& what, const std::string& before, const std::string& after,
                const std::string& more = "") {
  std::string line = fmt::format("  {:<40}{:>16}{:>16}", what, before, after);
  if (!more.empty()) line += "  " + more;
  return line + "\n";
}

std::string bounds_text(const TuneStory& story) {
  const Problem& problem = *story.problem;
  std::string text;
  for (std::size_t i = 0; i < problem.bounds().size(); ++i) {
    const Bound& bound = problem.bounds()[i];
    const auto& criterion = problem.criteria()[bound.criterion];
    text += row(labelled(criterion), number_of_runs(problem.before().bounded[i], criterion, problem.before()),
                number_of_runs(story.tuned.best.bounded[i], criterion, story.tuned.best),
                fmt::format("{} {} {:.9g}", story.tuned.best.held[i] ? "held," : "MISSED,", sign_of(bound),
                            bound.limit));
  }
  return text;
}

/// What simulate and stability tell of both, but for when things were and what is the same.
std::string alone_text(const TuneStory& story) {
  const Criteria& criteria = story.problem->criteria();
  std::string text = row("by itself, nothing drawn", std::string(name_of(story.before.end)),
                         std::string(name_of(story.after.end)));
  for (std::size_t i = 0; i < criteria.size(); ++i) {
    const double before = story.before.criteria[i], after = story.after.criteria[i];
    if ((std::isnan(before) && std::isnan(after)) || criteria[i].name == "ticks") continue;
    text += row("  " + labelled(criteria[i]), number(before), number(after));
  }
  return text;
}

std::string ending(const TuneStory& story) {
  const Tuned& tuned = story.tuned;
  std::string text;
  if (tuned.interrupted)
    text += fmt::format("  interrupted after {} evaluations; this is the best of them\n", tuned.evaluations);
  if (!tuned.best.is_known)
    text += fmt::format("  {} is there of no candidate; nothing is written\n", story.problem->goal().name);
  else if (!tuned.best.is_feasible())
    text +=
        "  nothing holds all bounds, this comes nearest to it; nothing is written. Wider ends (--over "
        "KEY=FROM..TO), more\n  --evaluations or other bounds may help\n";
  else if (!tuned.improves)
    text += "  nothing better was found: this is the experiment as it stands\n";
  for (const std::string& warning : story.warnings) text += "  warning: " + warning + "\n";
  if (!story.file.empty())
    text += "  " + as_called(fmt::format("written: mixloop simulate {}\n", printable_name(story.file)));
  if (!story.picture.empty()) text += "  drawn in " + printable_name(story.picture) + "\n";
  return text;
}

nlohmann::json json_of(const Problem::Alone& alone, const Criteria& criteria) {
  nlohmann::json json = {{"end", name_of(alone.end)}};
  for (std::size_t i = 0; i < criteria.size(); ++i)
    if (!std::isnan(alone.criteria[i])) json[criteria[i].name] = number_or_null(alone.criteria[i]);
  return json;
}

}  // namespace

int TuneStory::exit_status() const {
  if (tuned.interrupted) return kInterrupted;
  return tuned.best.is_feasible() && after.end == RunEnd::held ? kHeld : kMissed;
}

std::string head_of(const TuneStory& story) {
  const Problem& problem = *story.problem;
  std::string text =
      fmt::format("# {} tuned: {} {}", problem.setup().request().experiment.filename().string(),
                  problem.goal().maximises ? "maximise" : "minimise", problem.goal().name);
  std::string last;
  for (const Bound& bound : problem.bounds())
    if (bound.text != last) {
      text += "\n#   subject to " + printable_name(bound.text);
      last = bound.text;
    }
  for (std::size_t i = 0; i < problem.knobs().size(); ++i) {
    const Knob& knob = problem.knobs()[i];
    text += fmt::format("\n#   {}: {} (was {})", knob.key, knob.text_of(story.tuned.best.values[i]),
                        knob.text_of(knob.now));
  }
  return text + "\n";
}

std::string summary(const TuneStory& story) {
  const Problem& problem = *story.problem;
  const Assessment &before = problem.before(), &after = story.tuned.best;
  std::string text = fmt::format("{}: {} evaluations of {} run{} each", problem.setup().experiment().name,
                                 story.tuned.evaluations, problem.runs(), problem.runs() == 1 ? "" : "s");
  text += fmt::format("\n  {:<40}{:>16}{:>16}\n", "", "as it stands", "tuned");
  const auto& criterion = problem.criteria()[problem.goal().criteria[0]];
  text += row(problem.goal().name + (criterion.unit == "1" ? "" : " [" + criterion.unit + "]"),
              number_of_runs(before.goal, criterion, before), number_of_runs(after.goal, criterion, after),
              problem.goal().maximises ? "maximised" : "minimised");
  text += bounds_text(story);
  if (before.failed + after.failed > 0)
    text += row("runs that fail", fmt::format("{}", before.failed), fmt::format("{}", after.failed));
  for (std::size_t i = 0; i < problem.knobs().size(); ++i) {
    const Knob& knob = problem.knobs()[i];
    text += row(
        knob.key, knob.text_of(knob.now), knob.text_of(after.values[i]),
        fmt::format("{:.6g}..{:.6g}{}{}", knob.least, knob.most, knob.unit.empty() ? "" : " ", knob.unit));
  }
  return text + alone_text(story) + ending(story);
}

nlohmann::json json_of(const TuneStory& story) {
  const Problem& problem = *story.problem;
  const Assessment &before = problem.before(), &after = story.tuned.best;
  nlohmann::json json = {
      {"experiment", problem.setup().experiment().name},
      {"goal",
       {{"name", problem.goal().name},
        {"sense", problem.goal().maximises ? "maximise" : "minimise"},
        {"unit", problem.criteria()[problem.goal().criteria[0]].unit},
        {"before", number_or_null(before.goal)},
        {"after", number_or_null(after.goal)}}},
      {"subject", nlohmann::json::array()},
      {"values", nlohmann::json::array()},
      {"runs", problem.runs()},
      {"failed_runs", {{"before", before.failed}, {"after", after.failed}}},
      {"alone",
       {{"before", json_of(story.before, problem.criteria())},
        {"after", json_of(story.after, problem.criteria())}}},
      {"warnings", story.warnings},
      {"evaluations", story.tuned.evaluations},
      {"feasible", after.is_feasible()},
      {"improved", story.tuned.improves},
      {"interrupted", story.tuned.interrupted},
      {"file", story.file.empty() ? nlohmann::json(nullptr) : nlohmann::json(story.file)},
      {"picture", story.picture.empty() ? nlohmann::json(nullptr) : nlohmann::json(story.picture)},
      {"exit_status", story.exit_status()}};
  for (std::size_t i = 0; i < problem.bounds().size(); ++i) {
    const Bound& bound = problem.bounds()[i];
    const auto& criterion = problem.criteria()[bound.criterion];
    json["subject"].push_back({{"text", bound.text},
                               {"name", criterion.name},
                               {"unit", criterion.unit},
                               {"sign", sign_of(bound)},
                               {"bound", bound.limit},
                               {"before", number_or_null(before.bounded[i])},
                               {"after", number_or_null(after.bounded[i])},
                               {"held", static_cast<bool>(after.held[i])}});
  }
  for (std::size_t i = 0; i < problem.knobs().size(); ++i) {
    const Knob& knob = problem.knobs()[i];
    json["values"].push_back({{"key", knob.key},
                              {"unit", knob.unit},
                              {"before", knob.now},
                              {"after", after.values[i]},
                              {"from", knob.least},
                              {"to", knob.most}});
  }
  return json;
}

}  // namespace mixloop
