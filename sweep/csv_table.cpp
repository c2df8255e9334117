// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "loop/output_file.hpp"
#include "notation/long_work.hpp"
#include "sweep/table.hpp"

namespace mixloop {
namespace {

std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string titled(const std::string& name, const std::string& unit) {
  return field(unit.empty() || unit == "1" ? name : fmt::format("{} [{}]", name, unit));
}

std::string first_line(const Sweep& sweep) {
  std::string line = "run";
  for (const Variation& one : sweep.setup().design().variations()) line += "," + titled(one.key, one.unit);
  line += ",end";
  for (const auto& column : sweep.telling().columns.all()) line += "," + titled(column.name, column.unit);
  return line + (sweep.telling().hashes ? ",trajectory_sha256" : "") + ",error\n";
}

}  // namespace

void write_csv(const std::filesystem::path& file, const Sweep& sweep, const EachRun& each) {
  OutputFile out(file);
  out.write(first_line(sweep));
  const Design& design = sweep.setup().design();
  std::string line;
  each([&](const Outcome& outcome) {
    line.clear();
    const auto to = std::back_inserter(line);
    fmt::format_to(to, "{}", outcome.run);
    const auto values = design.values(outcome.run);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (design.variations()[i].is_number())
        fmt::format_to(to, ",{}", values[i].number);
      else
        line += "," + field(values[i].text);
    fmt::format_to(to, ",{}", name_of(outcome.end));
    for (const double value : outcome.values)
      if (std::isnan(value))
        line += ',';
      else
        fmt::format_to(to, ",{}", value);
    if (sweep.telling().hashes) line += "," + outcome.sha256;
    line += "," + outcome.code + "\n";
    out.write(line);
    work_goes_on("writing the table", outcome.run, sweep.runs());
  });
  out.publish();
}

}  // namespace mixloop
