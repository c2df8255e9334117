// SPDX-License-Identifier: MIT
#include "view/traces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "view/write_list.hpp"

namespace mixloop {
namespace {

/// The least and the greatest of [first, last) in the order in which they stand.
void add_extremes(std::vector<float>& out, std::size_t first, std::size_t last,
                  const std::function<float(std::size_t)>& at) {
  std::size_t least = last, greatest = last;
  for (std::size_t i = first; i < last; ++i) {
    if (std::isnan(at(i))) continue;
    if (least == last || at(i) < at(least)) least = i;
    if (greatest == last || at(i) > at(greatest)) greatest = i;
  }
  for (const std::size_t i : {std::min(least, greatest), std::max(least, greatest)})
    out.push_back(i == last ? NAN : at(i));
}

}  // namespace

void Traces::add(Trace trace) {
  if (ticks_.size() == most_) ticks_.pop_front();
  ticks_.push_back(std::move(trace));
  ++count_;
}

// t, x, y, z of at most `most` ticks from `first` on, the last of all among them.
void Traces::write_way(fmt::memory_buffer& out, std::size_t first, std::size_t most) const {
  const auto to = std::back_inserter(out);
  const std::size_t fresh = ticks_.size() - first, places = std::min(fresh, most);
  const char* between = "";
  for (std::size_t i = 1; i <= places; ++i) {
    const Trace& tick = ticks_[first + i * fresh / places - 1];
    const auto& [x, y, z] = tick.place;
    if (std::isnan(x)) continue;
    fmt::format_to(to, "{}{:.6f},{:.6g},{:.6g},{:.6g}", between, tick.t, x, y, z);
    between = ",";
  }
}

std::string Traces::since(std::int64_t from, std::size_t most_points) const {
  const auto size = static_cast<std::int64_t>(ticks_.size());
  const auto first = static_cast<std::size_t>(std::clamp<std::int64_t>(size - (count_ - from), 0, size));
  const std::size_t fresh = ticks_.size() - first, stretches = std::max<std::size_t>(1, most_points / 2);
  const bool whole = fresh <= most_points;
  const auto curve = [&](const std::function<float(std::size_t)>& at) {
    std::vector<float> values;
    for (std::size_t i = 0; whole && i < fresh; ++i) values.push_back(at(first + i));
    for (std::size_t i = 0; !whole && i < stretches; ++i)
      add_extremes(values, first + i * fresh / stretches, first + (i + 1) * fresh / stretches, at);
    return values;
  };
  fmt::memory_buffer out;
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "{{\"t\":[");
  const std::size_t points = whole ? fresh : 2 * stretches;
  for (std::size_t i = 0; i < points; ++i)
    fmt::format_to(to, "{}{:.6f}", i == 0 ? "" : ",", ticks_[first + (whole ? i : i * fresh / points)].t);
  fmt::format_to(to, "],\"error\":");
  write_list(out, curve([&](std::size_t i) { return ticks_[i].error; }));
  fmt::format_to(to, ",\"tau\":[");
  for (std::size_t motor = 0; motor < n_; ++motor) {
    if (motor > 0) out.push_back(',');
    write_list(out, curve([&](std::size_t i) { return ticks_[i].tau[motor]; }));
  }
  fmt::format_to(to, "],\"way\":[");
  write_way(out, first, most_points);
  fmt::format_to(to, "]}}");
  return fmt::to_string(out);
}

}  // namespace mixloop
