// SPDX-License-Identifier: MIT
// A log's messages as CSV, a file a channel.
#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "commands/commands.hpp"
#include "commands/shared/progress.hpp"
#include "loop/kept_files.hpp"
#include "loop/result.hpp"
#include "notation/utf8.hpp"
#include "processes/command_line.hpp"
#include "report/csv_folder.hpp"
#include "runtime/bus/log_reader.hpp"
#include "runtime/clock/stop_switch.hpp"
#include "watch/any_message.hpp"

namespace mixloop {
namespace {

struct ExportLine {
  std::string log, out;
  bool json = false;
};

/// Calls `column(name, what the .lcm file says of it)` for each number of a message.
template <class Column>
void name_columns(const AnyMessage& message, Column&& column) {
  const auto name = [&]<class Value>(const char* field, const char* said, const Value& value) {
    if constexpr (std::is_arithmetic_v<Value>)
      column(std::string(field), said);
    else if constexpr (std::is_array_v<Value> && std::extent_v<Value> == 3)
      for (const char axis : {'x', 'y', 'z'}) column(fmt::format("{}_{}", field, axis), said);
    else
      for (std::size_t i = 1; i <= std::size(value); ++i) column(fmt::format("{}_{}", field, i), said);
  };
  std::visit([&](const auto& m) { visit_fields(m, name); }, message);
}

/// Appends the numbers of a message, each after a comma, with the digits that read back as the same double.
void append_numbers(fmt::memory_buffer& line, const AnyMessage& message) {
  const auto add = [&line]<class Value>(const char*, const char*, const Value& value) {
    if constexpr (std::is_arithmetic_v<Value>)
      fmt::format_to(std::back_inserter(line), ",{}", +value);
    else
      for (const double x : value) fmt::format_to(std::back_inserter(line), ",{}", x);
  };
  std::visit([&](const auto& m) { visit_fields(m, add); }, message);
}

std::int32_t dimension(Bytes bytes) { return peek(bytes)->n; }

/// Writes events into their channels' files.
class Exporter {
 public:
  explicit Exporter(const std::filesystem::path& folder) : out_(folder), folder_(folder) {}

  void add(const LogEvent& event) {
    Channel& channel = channels_[std::string(event.channel)];
    if (!decode(event.data, message_)) {
      ++channel.undecodable;
      return;
    }
    if (!channel.file) begin(channel, event);
    if (channel.type != type_name(message_) || channel.n != dimension(event.data)) {
      ++channel.undecodable;
      return;
    }
    line_.clear();
    fmt::format_to(std::back_inserter(line_), "{}", event.received_us);
    append_numbers(line_, message_);
    line_.push_back('\n');
    folder_.write(*channel.file, {line_.data(), line_.size()});
    ++channel.rows;
  }

  /// Makes the files whole; what they are, for --json.
  nlohmann::json finish(const std::string& log) {
    auto files = nlohmann::json::array();
    auto skipped = nlohmann::json::object();
    for (const auto& [name, channel] : channels_)
      if (channel.file)
        files.push_back({{"channel", name},
                         {"type", channel.type},
                         {"n", channel.n},
                         {"file", folder_.name(*channel.file)},
                         {"rows", channel.rows},
                         {"undecodable", channel.undecodable}});
      else
        skipped[name] = channel.undecodable;
    if (files.empty())
      throw InputError(
          "no_messages", {log},
          fmt::format("none of its messages is of mixloop's types; it has the channels {}; expected "
                      "MIXLOOP_STATE, _COMMAND or another of docs/messages.md",
                      names(skipped)));
    write_columns();
    std::set<std::string> stale = exported_before();
    folder_.publish();
    for (const auto& file : files) stale.erase(file["file"]);
    for (const std::string& name : stale) std::filesystem::remove(out_ / name);
    return {{"files", files}, {"skipped_channels", skipped}};
  }

  static std::string names(const nlohmann::json& channels) {
    std::string text;
    for (const auto& [name, count] : channels.items()) {
      if (text.size() > 200) return text + ", ...";
      text += (text.empty() ? "" : ", ") + name;
    }
    return text.empty() ? "(none)" : text;
  }

 private:
  struct Channel {
    std::optional<std::size_t> file;
    std::string type;
    std::int32_t n = 0;
    std::int64_t rows = 0, undecodable = 0;
    std::vector<std::pair<std::string, std::string>> columns;
  };

  void begin(Channel& channel, const LogEvent& event) {
    channel.file = folder_.open(event.channel);
    channel.type = type_name(message_);
    channel.n = dimension(event.data);
    channel.columns.emplace_back("received_us", "us since 1970, when the logger received it");
    name_columns(message_, [&](const std::string& name, const char* said) {
      channel.columns.emplace_back(name, said);
    });
    std::string header;
    for (const auto& [name, said] : channel.columns) header += (header.empty() ? "" : ",") + name;
    folder_.write(*channel.file, header + "\n");
  }

  // What each column is, in words, beside the numbers.
  void write_columns() {
    const std::size_t file = folder_.open("columns");
    folder_.write(file, "file,column,meaning\n");
    for (const auto& [name, channel] : channels_)
      for (const auto& [column, said] : channel.columns)
        folder_.write(file, fmt::format("{},{},\"{}\"\n", folder_.name(*channel.file), column, said));
  }

  // By the columns.csv of an earlier export into the same folder: its files and this one's don't stand side
  // by side.
  std::set<std::string> exported_before() const {
    std::set<std::string> names;
    std::ifstream columns(out_ / "columns.csv");
    std::string line;
    std::getline(columns, line);
    if (line != "file,column,meaning") return names;
    while (std::getline(columns, line))
      if (const std::string name = line.substr(0, line.find(','));
          name.ends_with(".csv") && name.find('/') == std::string::npos)
        names.insert(name);
    return names;
  }

  std::filesystem::path out_;
  CsvFolder folder_;
  std::map<std::string, Channel> channels_;
  AnyMessage message_;
  fmt::memory_buffer line_;
};

void print_summary(const nlohmann::json& result) {
  for (const auto& file : result["files"]) {
    const auto undecodable = file["undecodable"].get<std::int64_t>();
    fmt::print("{:>10} rows  {}/{}  ({}){}\n", file["rows"].get<std::int64_t>(),
               result["out"].get<std::string>(), file["file"].get<std::string>(),
               file["type"].get<std::string>(),
               undecodable > 0 ? fmt::format("; {} messages left out: another type or n", undecodable) : "");
  }
  fmt::print("columns and their units: {}/columns.csv\n", printable_name(result["out"].get<std::string>()));
}

/// What a reader must know of where the numbers come from.
nlohmann::json notes_of(const std::string& log, const std::set<std::int64_t>& sessions) {
  auto notes = nlohmann::json::array();
  if (const std::string why = foreign_log(result_beside(log), log, sessions); !why.empty())
    notes.push_back(why);
  return notes;
}

int run(const ExportLine& options) {
  StopSwitch stop;
  stop.turn_on_signals();
  LogReader log(options.log);
  const std::string out = options.out.empty() ? options.log + ".csv" : options.out;
  Exporter exporter(out);
  Progress progress(options.log, log.size(), 1e6, "MB");
  std::set<std::int64_t> sessions;
  while (const LogEvent* event = log.next()) {
    if (stop.turned()) break;
    exporter.add(*event);
    if (const auto header = peek(event->data)) sessions.insert(header->session);
    progress.at(log.position());
  }
  progress.clear();
  if (stop.turned()) {
    if (!options.json)
      fmt::print(stderr, "mixloop: interrupted; nothing is kept in {}\n", printable_name(out));
    if (options.json) print_json({{"interrupted_at", log.position()}, {"files", nlohmann::json::array()}});
    return kInterrupted;
  }
  nlohmann::json result = exporter.finish(options.log);
  result.update({{"log", options.log},
                 {"out", out},
                 {"notes", notes_of(options.log, sessions)},
                 {"skipped_bytes", log.skipped_bytes()},
                 {"cut_off_bytes", log.cut_off_bytes()}});
  if (options.json) {
    print_json(result);
    return kHeld;
  }
  print_summary(result);
  for (const auto& note : result["notes"]) fmt::print(stderr, "mixloop: {}\n", note.get<std::string>());
  if (!log.damage().empty()) fmt::print(stderr, "mixloop: {}: {}\n", options.log, log.damage());
  if (!result["skipped_channels"].empty())
    fmt::print(stderr, "mixloop: {}: left out, not of mixloop's types: {}\n", printable_name(options.log),
               Exporter::names(result["skipped_channels"]));
  return kHeld;
}

}  // namespace

void add_export_command(CLI::App& command, int& status) {
  auto options = std::make_shared<ExportLine>();
  command
      .add_option("log", options->log, "an LCM event log: mixloop run --out's run.lcmlog, or lcm-logger's")
      ->required()
      ->type_name("LOG");
  command.add_option("--out", options->out, "the folder to write into; LOG.csv unless given")
      ->type_name("DIR");
  command.add_flag("--json", options->json,
                   "print one JSON object on stdout and nothing else, errors included");
  command.footer(
      "CHANNEL.csv has a row a message: received_us (the logger's clock), then the fields of its .lcm type, "
      "in SI\n"
      "units; arrays as psi_measured_1, _2, ..., vectors in space as position_x, _y, _z. Numbers have the "
      "digits\n"
      "that read back as the same double. columns.csv says what each column is, and its unit. A tick that "
      "comes\n"
      "twice was sent twice; a log may have gaps: see seq.\n"
      "Files appear when all of the log is through: after Ctrl-C there are none.\n"
      "Examples:\n"
      "  mixloop run experiments/paper.yaml --truth --out results/paper\n"
      "  mixloop export results/paper/run.lcmlog --out results/paper/csv\n"
      "  lcm-logger --lcm-url='udpm://239.255.76.67:7667?ttl=0' my.lcmlog   # in the run's network "
      "namespace");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
