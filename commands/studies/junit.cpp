// SPDX-License-Identifier: MIT
#include "commands/studies/junit.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <cmath>

#include "loop/output_file.hpp"

namespace mixloop {
namespace {

/// Of what was measured, in the order in which it is called.
class Properties {
 public:
  explicit Properties(tinyxml2::XMLElement& test) : list_(*test.InsertNewChildElement("properties")) {}

  void operator()(const std::string& name, double value, const std::string& unit) {
    if (!std::isfinite(value)) return;
    auto* property = list_.InsertNewChildElement("property");
    property->SetAttribute("name", fmt::format("{} [{}]", name, unit).c_str());
    property->SetAttribute("value", fmt::format("{}", value).c_str());
  }

 private:
  tinyxml2::XMLElement& list_;
};

void add_figures(tinyxml2::XMLElement& test, const SweepFigures& sweep) {
  Properties add(test);
  add("runs", static_cast<double>(sweep.runs), "1");
  for (const auto& figure : sweep.figures) add(figure.name, figure.value, figure.unit);
}

/// What was measured, as properties of the test.
void add_measures(tinyxml2::XMLElement& test, const RunFigures& run) {
  Properties add(test);
  add("max_position_error", run.measures.max_position_error, "m");
  add("time_of_max_position_error", run.measures.time_of_max_position_error, "s");
  add("final_position_error", run.measures.final_position_error, "m");
  add("rms_position_error", run.measures.rms_position_error, "m");
  if (run.measures.energy_drift) add("energy_drift", *run.measures.energy_drift, "1");
  if (const auto& psi = run.measures.final_psi)
    for (std::size_t i = 0; i < run.position_units.size(); ++i)
      add(fmt::format("final_psi[{}]", i), (*psi)[static_cast<Eigen::Index>(i)], run.position_units[i]);
  for (std::size_t i = 0; i < run.torque_units.size(); ++i)
    add(fmt::format("max_torque[{}]", i), run.measures.max_torque[static_cast<Eigen::Index>(i)],
        run.torque_units[i]);
}

}  // namespace

void write_junit(const std::string& file, std::span<const Result> results) {
  tinyxml2::XMLDocument document;
  document.InsertFirstChild(document.NewDeclaration());
  auto* suite = document.NewElement("testsuite");
  document.InsertEndChild(suite);
  suite->SetAttribute("name", "mixloop track");
  int failures = 0, errors = 0, skipped = 0;
  for (const auto& result : results) {
    auto* test = suite->InsertNewChildElement("testcase");
    test->SetAttribute("classname", "mixloop.track");
    test->SetAttribute("name", result.experiment.c_str());
    if (result.run) {
      test->SetAttribute("time", result.run->wall_time);
      add_measures(*test, *result.run);
    }
    if (result.sweep) {
      test->SetAttribute("time", result.sweep->wall_time);
      add_figures(*test, *result.sweep);
    }
    if (result.judged.verdict == Verdict::interrupted && (result.error || result.sweep)) {
      ++skipped;
      test->InsertNewChildElement("skipped")->SetAttribute(
          "message", result.error ? result.error->message.c_str() : "interrupted");
    } else if (result.error) {
      ++errors;
      auto* element = test->InsertNewChildElement("error");
      element->SetAttribute("type", result.error->code.c_str());
      element->SetAttribute("message", result.error->message.c_str());
    } else if (result.judged.verdict != Verdict::held) {
      ++failures;
      auto* element = test->InsertNewChildElement("failure");
      std::string message(result.judged.missed.empty() ? name_of(result.judged.verdict) : "");
      for (const auto& line : result.judged.missed) message += (message.empty() ? "" : "; ") + line;
      element->SetAttribute("message", message.c_str());
    }
  }
  suite->SetAttribute("tests", static_cast<int>(results.size()));
  suite->SetAttribute("failures", failures);
  suite->SetAttribute("errors", errors);
  suite->SetAttribute("skipped", skipped);
  tinyxml2::XMLPrinter text;
  document.Print(&text);
  write_file(file, text.CStr());
}

}  // namespace mixloop
