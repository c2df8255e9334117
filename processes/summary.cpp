// SPDX-License-Identifier: MIT
#include "processes/summary.hpp"

#include <fmt/format.h>

namespace mixloop {
namespace {

std::string endings(const Experiment& experiment, const Result& result) {
  const Measures& measures = result.run->measures;
  std::string text;
  if (measures.diverged_at)
    text += fmt::format(
        "  diverged at {:.6g} s: the position error passed {:.6g} mm or a value was not finite; nothing of "
        "that tick was published\n",
        *measures.diverged_at, experiment.position_error_limit * 1e3);
  if (measures.safe_at) {
    const bool caused = result.bus && result.bus->deadlines && result.bus->deadlines->safe_cause;
    text += fmt::format("  safe state from {:.6g} s on{}; what follows is judged up to there\n",
                        *measures.safe_at, caused ? ": " + *result.bus->deadlines->safe_cause : "");
  }
  if (measures.interrupted_at)
    text += fmt::format("  interrupted at {:.6g} s; what follows is up to there\n", *measures.interrupted_at);
  return text;
}

}  // namespace

std::string summary(const Experiment& experiment, const Result& result) {
  std::string text = fmt::format("{}: {}\n", experiment.name, name_of(result.judged.verdict));
  if (!result.run) return text;
  const RunFigures& run = *result.run;
  const Measures& measures = run.measures;
  text += endings(experiment, result);
  text += fmt::format("  position error   max {:.7f} mm at {:.6g} s, final {:.7f} mm, rms {:.7f} mm\n",
                      measures.max_position_error * 1e3, measures.time_of_max_position_error,
                      measures.final_position_error * 1e3, measures.rms_position_error * 1e3);
  text += "  max torque      ";
  for (const double value : measures.max_torque) text += fmt::format(" {:.5f}", value);
  text += " N m\n";
  text += fmt::format("  {} ticks at {:g} Hz by {} in {:.3f} s ({})\n", measures.ticks, experiment.rate_hz,
                      run.route, run.wall_time, run.evaluation);
  if (run.integrator.chosen) text += "  integrator       " + run.integrator.chosen->why + "\n";
  text += "  trajectory       " + measures.trajectory_sha256 + "\n";
  for (const auto& line : result.judged.missed) text += "  missed: " + line + "\n";
  return text;
}

std::string bus_summary(const Result& result) {
  if (!result.bus) return {};
  const BusFigures& bus = *result.bus;
  std::string text;
  if (const auto& deadlines = bus.deadlines) {
    const auto wake_up = bus.wake_up.value_or(BusFigures::Quantiles{});
    text += fmt::format(
        "  commands         {} missed ({} in a row at most), {:.0f} % of the last 100 in time\n"
        "  wake-up          p50 {:.1f} us, p99 {:.1f} us, max {:.1f} us; plant time slipped {} times, by "
        "{:.6f} s\n",
        bus.missed_deadlines, deadlines->longest_miss, deadlines->success_last_100 * 100, wake_up.p50 * 1e6,
        wake_up.p99 * 1e6, wake_up.max * 1e6, deadlines->overruns, bus.slipped);
  }
  return text + fmt::format(
                    "  round trip       p50 {:.1f} us, p99 {:.1f} us, max {:.1f} us; {} states sent "
                    "again\n",
                    bus.round_trip.p50 * 1e6, bus.round_trip.p99 * 1e6, bus.round_trip.max * 1e6, bus.resent);
}

}  // namespace mixloop
