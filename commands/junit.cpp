// SPDX-License-Identifier: MIT
#include "commands/junit.hpp"

#include <tinyxml2.h>

#include "loop/output_file.hpp"

namespace mixloop {

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
    if (result.run) test->SetAttribute("time", result.run->wall_time);
    if (result.error && result.judged.verdict == Verdict::interrupted) {
      ++skipped;
      test->InsertNewChildElement("skipped")->SetAttribute("message", result.error->message.c_str());
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
