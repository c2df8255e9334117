// SPDX-License-Identifier: MIT
#include "commands/records/sweep_page.hpp"

#include <bit>
#include <cmath>

#include "report/packed.hpp"
#include "report/page.hpp"

namespace mixloop {
namespace {

using nlohmann::ordered_json;

constexpr std::uint32_t kNoRun = 0xffffffff;

ordered_json axis_json(const Axis& axis) {
  static constexpr const char* kKinds[] = {"even", "values", "words"};
  ordered_json json = {{"kind", kKinds[static_cast<std::size_t>(axis.kind)]},
                       {"logarithmic", axis.logarithmic},
                       {"from", number_or_null(axis.from)},
                       {"to", number_or_null(axis.to)},
                       {"cells", axis.inner}};
  if (axis.kind == Axis::Kind::values) json["values"] = axis.values;
  return json;
}

ordered_json variable_json(const Variable& variable, const Axis& in_maps) {
  static constexpr const char* kKinds[] = {"drawn", "listed", "words", "measured", "held"};
  const ColumnStatistics& of = variable.statistics;
  ordered_json json = {{"name", variable.name},
                       {"unit", variable.unit},
                       {"kind", kKinds[static_cast<std::size_t>(variable.kind)]},
                       {"least_is_worst", variable.least_is_worst},
                       {"measured", of.measured},
                       {"mean", number_or_null(of.mean)},
                       {"deviation", number_or_null(of.deviation)},
                       {"least", number_or_null(of.least)},
                       {"most", number_or_null(of.most)},
                       {"run_of_least", of.run_of_least},
                       {"run_of_most", of.run_of_most},
                       {"quantiles", ordered_json::array()},
                       {"axis", axis_json(variable.axis)},
                       {"map_axis", axis_json(in_maps)},
                       {"histogram", variable.histogram}};
  if (!variable.words.empty()) json["words"] = variable.words;
  for (std::size_t i = 0; i < of.quantiles.size(); ++i)
    json["quantiles"].push_back({ColumnStatistics::kShares[i], number_or_null(of.quantiles[i])});
  return json;
}

/// To four and a half digits, which no picture needs more of, and whose rest packs to nothing.
std::uint32_t bits_of(double value) {
  const auto number = static_cast<float>(value);
  const auto bits = std::bit_cast<std::uint32_t>(number);
  return std::isfinite(number) ? (bits + 0x100) & ~std::uint32_t{0x1ff} : bits;
}

/// The cells that are not empty: their numbers, how many runs; of each metric mean, worst and the run of the
/// worst.
void put_cells(const Density& density, std::size_t metrics, const std::vector<std::uint32_t>& cells,
               std::vector<std::uint32_t>& to) {
  to.insert(to.end(), cells.begin(), cells.end());
  for (const std::uint32_t cell : cells) to.push_back(static_cast<std::uint32_t>(density.runs(cell)));
  for (std::size_t m = 0; m < metrics; ++m) {
    const auto put = [&](const auto& number) {
      for (const std::uint32_t cell : cells) to.push_back(number(density.metric(cell, m)));
    };
    using Metric = Density::Metric;
    put([](const Metric& one) { return bits_of(one.measured > 0 ? one.mean() : NAN); });
    put([](const Metric& one) { return bits_of(one.measured > 0 ? one.worst : NAN); });
    put([](const Metric& one) { return one.measured > 0 ? static_cast<std::uint32_t>(one.run) : kNoRun; });
  }
}

ordered_json maps_json(const Reduction& reduction) {
  std::vector<std::uint32_t> numbers;
  ordered_json list = ordered_json::array();
  for (const DensityMap& map : reduction.maps) {
    std::vector<std::uint32_t> cells;
    for (std::size_t i = 0; i < map.density.cells(); ++i)
      if (map.density.runs(i) > 0) cells.push_back(static_cast<std::uint32_t>(i));
    list.push_back({{"x", map.x}, {"y", map.y}, {"first", numbers.size()}, {"cells", cells.size()}});
    put_cells(map.density, reduction.metrics.size(), cells, numbers);
  }
  return {{"list", list}, {"numbers", numbers.size()}, {"packed", packed(numbers)}};
}

ordered_json influences_json(const Reduction& reduction) {
  static constexpr const char* kMissing[] = {"", "too_few", "partly_run"};
  ordered_json list = ordered_json::array();
  for (const MetricInfluence& metric : reduction.influences) {
    ordered_json entries = ordered_json::array();
    for (const auto& one : metric.entries)
      entries.push_back({{"entry", one.entry},
                         {"classes", one.classes},
                         {"share", number_or_null(one.influence.share)},
                         {"doubt", number_or_null(one.influence.doubt)},
                         {"share_of_ranks", number_or_null(one.on_ranks.share)},
                         {"doubt_of_ranks", number_or_null(one.on_ranks.doubt)},
                         {"rank_correlation", number_or_null(one.rank_correlation)}});
    list.push_back({{"metric", metric.metric},
                    {"missing", kMissing[static_cast<std::size_t>(metric.missing)]},
                    {"runs", metric.runs},
                    {"entries", entries}});
  }
  return list;
}

ordered_json worst_json(const KeptSweep& sweep, const Reduction& reduction) {
  ordered_json list = ordered_json::array();
  for (std::size_t m = 0; m < reduction.metrics.size(); ++m) {
    ordered_json cases = ordered_json::array();
    for (const WorstRun& one : reduction.worst[m]) {
      ordered_json values = ordered_json::array();
      const auto entries = sweep.design.values(one.run);
      for (std::size_t i = 0; i < entries.size(); ++i)
        values.push_back(sweep.design.variations()[i].is_number() ? number_or_null(entries[i].number)
                                                                  : ordered_json(entries[i].text));
      cases.push_back({{"run", one.run},
                       {"value", number_or_null(one.value)},
                       {"end", name_of(one.end)},
                       {"entries", values},
                       {"command", sweep.command(one.run)}});
    }
    if (!cases.empty()) list.push_back({{"metric", reduction.metrics[m]}, {"cases", cases}});
  }
  return list;
}

ordered_json ends_json(const KeptSweep& sweep, const Statistics& statistics) {
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < kRunEnds; ++i)
    if (statistics.ends[i] > 0)
      list.push_back({{"end", name_of(static_cast<RunEnd>(i))},
                      {"runs", statistics.ends[i]},
                      {"first", statistics.first[i]},
                      {"error", statistics.code[i]},
                      {"command", sweep.command(statistics.first[i])}});
  return list;
}

}  // namespace

ordered_json sweep_page_data(const KeptSweep& sweep, const Reduction& reduction, const ordered_json& expect,
                             const std::vector<std::string>& notes) {
  ordered_json entries = ordered_json::array(), set = ordered_json::array(),
               variables = ordered_json::array();
  for (const Variation& one : sweep.design.variations())
    entries.push_back({{"key", one.key},
                       {"drawn", one.distribution.has_value()},
                       {"values", one.distribution ? 0 : one.size()},
                       {"text", one.size() > 40 ? "" : one.written()}});
  for (const Override& one : sweep.overrides) set.push_back(one.key + " = " + one.value);
  for (std::size_t i = 0; i < reduction.variables.size(); ++i)
    variables.push_back(variable_json(reduction.variables[i], reduction.axes[i]));
  return {{"mixloop", MIXLOOP_VERSION},
          {"sweep", sweep.name},
          {"experiment", sweep.experiment.string()},
          {"called", sweep.called},
          {"set", set},
          {"entries", entries},
          {"spread", sweep.spread},
          {"seed", std::to_string(sweep.seed)},
          {"draws", sweep.design.draws()},
          {"runs", sweep.design.runs()},
          {"done", reduction.ends.runs},
          {"notes", notes},
          {"ends", ends_json(sweep, reduction.ends)},
          {"expect", expect},
          {"variables", variables},
          {"metrics", reduction.metrics},
          {"placed", reduction.placed},
          {"influences", influences_json(reduction)},
          {"worst", worst_json(sweep, reduction)},
          {"maps", maps_json(reduction)}};
}

}  // namespace mixloop
