// SPDX-License-Identifier: MIT
#include <system_error>

#include "notation/errors.hpp"
#include "notation/long_work.hpp"
#include "sweep/table.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kLongestCode = 32;

std::vector<FileColumn> columns_of(const Sweep& sweep) {
  using Kind = FileColumn::Kind;
  std::vector<FileColumn> columns = {{.name = "run", .kind = Kind::whole}};
  for (const Variation& one : sweep.setup().design().variations()) {
    columns.push_back({.name = one.key, .unit = one.unit});
    if (one.is_number()) continue;
    columns.back().kind = Kind::text;
    columns.back().width = 1;
    for (const auto& text : one.texts) columns.back().width = std::max(columns.back().width, text.size());
  }
  columns.push_back({.name = "end", .kind = Kind::word, .width = 1});
  for (std::size_t i = 0; i < kRunEnds; ++i)
    columns.back().words.emplace_back(name_of(static_cast<RunEnd>(i)));
  for (const auto& column : sweep.telling().columns.all())
    columns.push_back({.name = column.name, .unit = column.unit == "1" ? "" : column.unit});
  if (sweep.telling().hashes)
    columns.push_back({.name = "trajectory_sha256", .kind = Kind::text, .width = 64});
  columns.push_back({.name = "error", .kind = Kind::text, .width = kLongestCode});
  return columns;
}

template <class T>
std::string_view bytes_in(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

}  // namespace

void write_columns(const std::filesystem::path& file, const Sweep& sweep, const EachRun& each,
                   WriteColumns write) {
  const Design& design = sweep.setup().design();
  std::vector<std::string_view> row;
  const EachRow each_row = [&](const auto& told) {
    each([&](const Outcome& outcome) {
      const auto values = design.values(outcome.run);
      row = {bytes_in(outcome.run)};
      for (std::size_t i = 0; i < values.size(); ++i)
        row.push_back(design.variations()[i].is_number() ? bytes_in(values[i].number)
                                                         : std::string_view(values[i].text));
      row.push_back(bytes_in(outcome.end));
      for (const double& value : outcome.values) row.push_back(bytes_in(value));
      if (sweep.telling().hashes) row.push_back(outcome.sha256);
      row.push_back(outcome.code);
      told(row);
      work_goes_on("writing the table", outcome.run, sweep.runs());
    });
  };
  const std::filesystem::path part = file.string() + ".part";
  try {
    write(part, columns_of(sweep), sweep.runs(), each_row);
    std::filesystem::rename(part, file);
  } catch (const std::system_error& error) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw RunFault("cannot_write", "cannot write " + file.string() + ": " + error.code().message());
  }
}

}  // namespace mixloop
