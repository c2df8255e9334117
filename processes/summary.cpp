// SPDX-License-Identifier: MIT
#include "processes/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dynamics/scene/coordinate_values.hpp"
#include "notation/number_text.hpp"

namespace mixloop {
namespace {

/// What a run has diverged by, beside what is not finite.
std::string watched(const Experiment& experiment) {
  std::string text;
  if (experiment.has_path() && experiment.scene->end_effector.named)
    text += fmt::format("the position error passed {:.6g} mm or ", experiment.position_error_limit * 1e3);
  if (!experiment.limits.motor_error.empty()) text += "a motor's error passed limits.motor_error or ";
  return text;
}

std::string endings(const Experiment& experiment, const Result& result) {
  const Measures& measures = result.run->measures;
  std::string text;
  if (measures.no_way_on)
    text += fmt::format("  ended at {:.6g} s: {}\n", *measures.diverged_at, *measures.no_way_on);
  else if (measures.diverged_at)
    text +=
        fmt::format("  diverged at {:.6g} s: {}a value was not finite; nothing of that tick was published\n",
                    *measures.diverged_at, watched(experiment));
  if (measures.safe_at) {
    const bool caused = result.bus && result.bus->deadlines && result.bus->deadlines->safe_cause;
    text += fmt::format("  safe state from {:.6g} s on{}; what follows is judged up to there\n",
                        *measures.safe_at, caused ? ": " + *result.bus->deadlines->safe_cause : "");
  }
  if (measures.interrupted_at)
    text += fmt::format("  interrupted at {:.6g} s; what follows is up to there\n", *measures.interrupted_at);
  return text;
}

std::string position_error(const Measures& measures) {
  if (std::isnan(measures.max_position_error)) return "never measured: no tick of the path was judged";
  const auto mm = [](double error) { return fixed(error * 1e3, 7) + " mm"; };
  return fmt::format("max {} at {:.6g} s, final {}, rms {}", mm(measures.max_position_error),
                     measures.time_of_max_position_error, mm(measures.final_position_error),
                     mm(measures.rms_position_error));
}

/// A position of each coordinate, or how far it is off.
std::string positions(std::span<const Scene::Independent> coordinates, const Vector& psi) {
  if (psi.hasNaN()) return "never measured: no tick was judged";
  std::string text;
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    text += fmt::format("{}{} {} {}", i > 0 ? ", " : "", coordinates[i].name,
                        fixed(psi[static_cast<Eigen::Index>(i)], 9), position_unit(coordinates[i].linear));
  return text;
}

std::string energy_drift(double drift) {
  if (std::isnan(drift)) return "never measured: the motors' work isn't told, or a fault changed the plant";
  return fmt::format("{:.3g} of the largest energy, the motors' work taken off", drift);
}

bool all_linear(const RunFigures& run) {
  return !run.torque_units.empty() &&
         std::ranges::all_of(run.torque_units, [](const auto& unit) { return unit == "N"; });
}

/// The unit once where all motors have the same.
std::string max_torque(const RunFigures& run) {
  const Vector& torque = run.measures.max_torque;
  if (torque.hasNaN()) return "never measured: no command was judged";
  std::string text;
  for (std::size_t i = 0; i < run.torque_units.size(); ++i) {
    const bool last_of_unit =
        i + 1 == run.torque_units.size() || run.torque_units[i + 1] != run.torque_units[i];
    text += fmt::format("{}{}{}", i > 0 ? " " : "", fixed(torque[static_cast<Eigen::Index>(i)], 5),
                        last_of_unit ? " " + run.torque_units[i] : "");
  }
  return text;
}

std::string times(const BusFigures::Quantiles& of) {
  if (std::isnan(of.max)) return "never measured";
  return fmt::format("p50 {:.1f} us, p99 {:.1f} us, max {:.1f} us", of.p50 * 1e6, of.p99 * 1e6, of.max * 1e6);
}

std::string deadlines(const BusFigures& bus) {
  const auto& deadlines = *bus.deadlines;
  const double in_time = deadlines.success_last_100;
  return fmt::format(
      "  commands         {} missed ({} in a row at most), {}\n"
      "  wake-up          {}; plant time slipped {} times, by {:.6f} s\n",
      bus.missed_deadlines, deadlines.longest_miss,
      std::isnan(in_time) ? "no tick was counted"
                          : fmt::format("{:.0f} % of the last 100 in time", in_time * 100),
      times(bus.wake_up.value_or(BusFigures::Quantiles{})), deadlines.overruns, bus.slipped);
}

}  // namespace

std::string summary(const Experiment& experiment, const Result& result) {
  std::string text = fmt::format("{}: {}\n", experiment.name, name_of(result.judged.verdict));
  if (!result.run) return text;
  const RunFigures& run = *result.run;
  const Measures& measures = run.measures;
  text += endings(experiment, result);
  if (measures.follows_path) text += "  position error   " + position_error(measures) + "\n";
  if (measures.is_oriented)
    text += fmt::format("  orientation      off by {:.4g} rad at most\n", measures.max_orientation_error);
  if (measures.max_motor_error)
    text += "  motor errors     " + positions(experiment.scene->motors(), *measures.max_motor_error) + "\n";
  if (measures.final_psi)
    text += "  final position   " + positions(experiment.scene->independent, *measures.final_psi) + "\n";
  if (measures.energy_drift) text += "  energy drift     " + energy_drift(*measures.energy_drift) + "\n";
  if (measures.max_torque.size() > 0)
    text += fmt::format("  max {:<13}", all_linear(run) ? "force" : "torque") + max_torque(run) + "\n";
  text += fmt::format("  {} ticks at {:g} Hz by {} in {:.3f} s ({})\n", measures.ticks, experiment.rate_hz,
                      run.route, run.wall_time, run.evaluation);
  if (run.integrator.chosen) text += "  integrator       " + run.integrator.chosen->why + "\n";
  if (!measures.trajectory_sha256.empty()) text += "  trajectory       " + measures.trajectory_sha256 + "\n";
  if (const auto missing = result.missing_ticks.value_or(0); missing > 0)
    text += fmt::format("  {} ticks are missing: the rest was heard and measured\n", missing);
  for (const auto& line : result.judged.missed) text += "  missed: " + line + "\n";
  return text;
}

std::string bus_summary(const Result& result) {
  if (!result.bus) return {};
  const BusFigures& bus = *result.bus;
  return (bus.deadlines ? deadlines(bus) : "") +
         fmt::format("  round trip       {}; {} states sent again\n", times(bus.round_trip), bus.resent);
}

}  // namespace mixloop
