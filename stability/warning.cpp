// SPDX-License-Identifier: MIT
#include "stability/warning.hpp"

#include <fmt/format.h>

#include <functional>

#include "stability/survey.hpp"

namespace mixloop {
namespace {

constexpr int kPoses = 9;
constexpr double kNear = 0.1;  // of a tick

std::string limit_text(const char* what, const std::optional<double>& limit) {
  if (!limit) return fmt::format("no {} is too long", what);
  return *limit > 0 ? fmt::format("the longest {} is {:.3f} ms", what, *limit * 1e3)
                    : fmt::format("no {} is short enough", what);
}

/// The instant whose radius is the largest.
std::size_t worst_instant(const Survey& survey, const auto& radius) {
  std::size_t worst = 0;
  double largest = 0;
  for (std::size_t i = 0; i < survey.loops.size(); ++i)
    if (const double here = radius(survey.loops[i]); here > largest) worst = i, largest = here;
  return worst;
}

using Where = std::function<std::string(double time)>;

std::vector<std::string> held_warnings(const Survey& survey, const Where& where) {
  const auto [tick, delay] = survey.sampling;
  const auto worst_at = [&](const Sampling& sampling) {
    return worst_instant(
        survey, [&](const LinearLoop& loop) { return sampled_radius(loop, loop.feedback.gain(), sampling); });
  };
  const auto describe = [&](std::size_t i, const char* verdict) {
    const Limits limits = limits_of(survey.loops[i], survey.sampling);
    return fmt::format(
        "the sampled loop {} {}: with a tick of {:.3f} ms {}, with a delay of {:.3f} ms "
        "{} "
        "(mixloop stability says more)",
        verdict, where(survey.times[i]), tick * 1e3, limit_text("command delay", limits.longest_delay),
        delay * 1e3, limit_text("tick", limits.longest_tick));
  };
  const std::size_t now = worst_at({tick, delay});
  const auto radius = [&](std::size_t i, const Sampling& sampling) {
    return sampled_radius(survey.loops[i], survey.loops[i].feedback.gain(), sampling);
  };
  if (grows(radius(now, {tick, delay}))) return {describe(now, "is unstable")};
  for (const Sampling& further : {Sampling{tick * (1 + kNear), delay}, Sampling{tick, delay + kNear * tick}})
    if (const std::size_t i = worst_at(further); grows(radius(i, further)))
      return {describe(i, "is near its limit")};
  return {};
}

std::vector<std::string> continuous_warnings(const Survey& survey, double step, const Where& where) {
  const auto radius = [&](const LinearLoop& loop, double h) {
    return rk4_radius(poles(loop, loop.feedback.gain()), h);
  };
  const std::size_t worst = worst_instant(survey, [&](const LinearLoop& loop) { return radius(loop, step); });
  const LinearLoop& loop = survey.loops[worst];
  const bool unstable = grows(radius(loop, step));
  if (!unstable && !grows(radius(loop, step * (1 + kNear)))) return {};
  return {fmt::format("RK4 steps of {:.3f} ms {} {}: {} (mixloop stability says more)", step * 1e3,
                      unstable ? "are too long" : "are near their limit", where(survey.times[worst]),
                      limit_text("step", limits_of(loop, survey.sampling).longest_rk4_step))};
}

}  // namespace

std::vector<std::string> stability_warnings(const Experiment& experiment, const Plan& plan) try {
  // With control at every stage the limit is the method's, and RK4's is the one at hand.
  if (experiment.plant.continuous && experiment.plant.integrator != Method::rk4) return {};
  if (!closes_loop(experiment)) return {};
  const Survey instants = survey(experiment, plan, kPoses);
  const Where where = [&](double time) {
    return plan.has_path() ? fmt::format("at {:.3f} s of the path", time)
                           : std::string("about the state that it feeds back about");
  };
  return experiment.plant.continuous
             ? continuous_warnings(instants, instants.sampling.tick / experiment.plant.substeps, where)
             : held_warnings(instants, where);
} catch (const InputError& error) {
  if (error.code != "too_large") throw;  // what no program may be as long as: no run needs it
  return {"whether the loop is stable was not looked at: " + error.message};
}

}  // namespace mixloop
