// SPDX-License-Identifier: MIT
#include "processes/bus_figures.hpp"

namespace mixloop {
namespace {

double seconds(nanoseconds time) { return std::chrono::duration<double>(time).count(); }

BusFigures::Quantiles quantiles(const Histogram& histogram) {
  if (histogram.count() == 0) return {};
  return {.p50 = seconds(histogram.quantile(0.5)),
          .p99 = seconds(histogram.quantile(0.99)),
          .p999 = seconds(histogram.quantile(0.999)),
          .max = seconds(histogram.max())};
}

}  // namespace

BusFigures bus_figures(const PlantReport& report) {
  BusFigures figures{.resent = report.resent,
                     .round_trip = quantiles(report.round_trip),
                     .slipped = seconds(report.slipped),
                     .rejected = report.rejects.total(),
                     .refused_faults = report.refused_faults,
                     .dropped = report.dropped,
                     .joined_late = report.joined_late > 0};
  if (report.wake_up.count() > 0) figures.wake_up = quantiles(report.wake_up);
  for (const RejectRow& row : kRejects)
    figures.rejected_by_cause[std::string(row.name)] = report.rejects.of(row.cause);
  return figures;
}

void add_deadlines(BusFigures& figures, const PlantReport& report, const DeadlinePlant& plant,
                   SafeState safe_state) {
  figures.missed_deadlines = plant.missed();
  auto& deadlines = figures.deadlines.emplace();
  deadlines.longest_miss = plant.longest_miss();
  if (plant.state().counted > 0) deadlines.success_last_100 = plant.success_last_100();
  deadlines.overruns = report.overruns;
  if (!plant.safe()) return;
  deadlines.safe_cause = plant.safe()->cause;
  deadlines.safe_state = name_of(safe_state);
}

}  // namespace mixloop
