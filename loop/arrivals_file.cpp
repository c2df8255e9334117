// SPDX-License-Identifier: MIT
#include "loop/arrivals_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <limits>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>

#include "loop/output_file.hpp"
#include "notation/errors.hpp"

namespace mixloop {
namespace {

constexpr const char* kHeader = "tick,offset_ns,command,how";
constexpr std::string_view kSafeState = "safe state: ", kFault = "fault: ", kExtrapolated = "extrapolated ",
                           kAfterwards = " then safe";

std::string text_of(const Arrival& arrival) {
  const std::string how = arrival.ahead == Arrival::kBlind ? "safe"
                          : arrival.ahead == 0             ? "law"
                                               : fmt::format("{}{}", kExtrapolated, arrival.ahead);
  return arrival.afterwards ? fmt::format("{}{}", how, kAfterwards) : how;
}

/// Of a fault: target, kind, index from 1 (0: all), magnitude, from, for.
std::string text_of(const Intervention& i) {
  if (i.cause != nullptr) return fmt::format("{}{}", kSafeState, i.cause);
  const Fault& f = i.fault;
  return fmt::format("{}{} {} {} {} {} {}", kFault, Fault::kTargets[static_cast<std::size_t>(f.target)],
                     Fault::kKinds[static_cast<std::size_t>(f.kind)], f.index + 1, f.magnitude, f.at,
                     f.duration);
}

/// A text that stays where it is as long as the process lives: there are few causes.
const char* interned(std::string_view text) {
  static std::mutex mutex;
  static std::set<std::string, std::less<>> texts;
  const std::lock_guard lock(mutex);
  return texts.emplace(text).first->c_str();
}

/// A line of the file, in its four fields.
struct Line {
  std::array<std::string_view, 4> fields;
  Place place;
};

[[noreturn]] void refuse(const Line& line, const std::string& expected) {
  throw InputError("invalid_arrival", line.place,
                   fmt::format("found '{},{},{},{}'; expected {}", line.fields[0], line.fields[1],
                               line.fields[2], line.fields[3], expected));
}

Line split(std::string_view text, Place place) {
  Line line{.fields = {}, .place = std::move(place)};
  for (std::size_t i = 0; i < line.fields.size(); ++i) {
    const std::size_t comma = i + 1 < line.fields.size() ? text.find(',') : std::string_view::npos;
    line.fields[i] = text.substr(0, comma);
    if (comma == std::string_view::npos) {
      if (i + 1 < line.fields.size()) refuse(line, fmt::format("the four fields {}", kHeader));
      break;
    }
    text.remove_prefix(comma + 1);
  }
  return line;
}

std::int64_t whole_number(std::string_view text, const Line& line) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || text.empty())
    refuse(line, fmt::format("a whole number in place of '{}'", text));
  return number;
}

Arrival arrival_in(const Line& line) {
  Arrival arrival{.tick = whole_number(line.fields[0], line),
                  .offset = whole_number(line.fields[1], line),
                  .command = whole_number(line.fields[2], line)};
  std::string_view how = line.fields[3];
  arrival.afterwards = how.ends_with(kAfterwards);
  if (arrival.afterwards) how.remove_suffix(kAfterwards.size());
  if (how == "safe")
    arrival.ahead = Arrival::kBlind;
  else if (how.starts_with(kExtrapolated))
    arrival.ahead = whole_number(how.substr(kExtrapolated.size()), line);
  else if (how != "law")
    refuse(line, "'law', 'extrapolated N' or 'safe' at its end, or one of them 'then safe'");
  return arrival;
}

template <std::size_t N>
std::optional<std::size_t> index_of(const std::array<std::string_view, N>& words, std::string_view word) {
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) return std::nullopt;
  return static_cast<std::size_t>(found - words.begin());
}

Fault fault_in(std::string_view text, const Line& line) {
  std::istringstream in{std::string(text)};
  std::string target, kind, rest;
  int number = 0;
  Fault fault;
  in >> target >> kind >> number >> fault.magnitude >> fault.at >> fault.duration;
  const auto which = index_of(Fault::kTargets, target), what = index_of(Fault::kKinds, kind);
  if (in.fail() || in >> rest || !which || !what || number < 0)
    refuse(line, "'fault: TARGET KIND INDEX MAGNITUDE AT FOR'");
  fault.target = static_cast<Fault::Target>(*which);
  fault.kind = static_cast<Fault::Kind>(*what);
  fault.index = number - 1;
  return fault;
}

Intervention intervention_in(const Line& line) {
  Intervention intervention{.tick = whole_number(line.fields[0], line)};
  const std::string_view text = line.fields[3];
  if (text.starts_with(kSafeState))
    intervention.cause = interned(text.substr(kSafeState.size()));
  else if (text.starts_with(kFault))
    intervention.fault = fault_in(text.substr(kFault.size()), line);
  else
    refuse(line, "'fault: ...' or 'safe state: ...' where there is no command");
  return intervention;
}

/// Whether it could have happened, after those before it.
bool sound(const Arrival& arrival, const std::vector<Arrival>& before) {
  const bool alone = arrival.command >= 0 && arrival.command <= arrival.tick && arrival.offset >= 0 &&
                     arrival.ahead >= Arrival::kBlind && arrival.ahead <= arrival.command;
  if (before.empty()) return alone && arrival.command == 0;
  return alone && arrival.command > before.back().command && arrival.tick >= before.back().tick;
}

}  // namespace

std::string write_arrivals(const std::filesystem::path& file, const Arrivals& arrivals) {
  std::ostringstream out;
  out << kHeader << '\n';
  auto next = arrivals.interventions.begin();
  const auto write_until = [&](std::int64_t tick) {
    for (; next != arrivals.interventions.end() && next->tick <= tick; ++next)
      out << next->tick << ",,," << text_of(*next) << '\n';
  };
  for (const Arrival& a : arrivals.commands) {
    write_until(a.tick - 1);
    out << a.tick << ',' << a.offset << ',' << a.command << ',' << text_of(a) << '\n';
  }
  write_until(std::numeric_limits<std::int64_t>::max());
  return write_file(file, out.view());
}

Arrivals read_arrivals(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw InputError("no_such_file", {file.string()}, "cannot be read; expected a run's ages.csv");
  std::string text;
  int number = 1;
  if (!std::getline(in, text) || text != kHeader)
    throw InputError("invalid_arrival", {file.string(), number},
                     fmt::format("found '{}'; expected the header {}", text.substr(0, 60), kHeader));
  Arrivals arrivals;
  while (std::getline(in, text)) {
    const Line line = split(text, {file.string(), ++number});
    if (line.fields[1].empty() && line.fields[2].empty()) {
      arrivals.interventions.push_back(intervention_in(line));
      continue;
    }
    const Arrival arrival = arrival_in(line);
    if (!sound(arrival, arrivals.commands))
      throw InputError("out_of_range", line.place,
                       "a command cannot arrive before its state, before an older one, or without command 0 "
                       "before it");
    arrivals.commands.push_back(arrival);
  }
  if (arrivals.commands.empty()) throw InputError("missing_entry", {file.string(), number}, "no arrivals");
  return arrivals;
}

}  // namespace mixloop
