// SPDX-License-Identifier: MIT
#include "stability/limits.hpp"

#include <cmath>

#include "notation/long_work.hpp"

namespace mixloop {
namespace {

constexpr double kFarTicks = 100, kFarGain = 1000, kFarDelay = 20;  // how far to look
constexpr double kStretch = 1.04;                                   // from one look to the next

double stretched(double x) { return x * kStretch; }

/// Kp and Kv times a factor, all of them or one motor's.
Matrix scaled_gain(const Feedback& feedback, double factor, Eigen::Index motor = -1) {
  Matrix proportional = feedback.proportional;
  if (motor < 0)
    proportional *= factor;
  else
    proportional.row(motor) *= factor;
  return proportional + feedback.model;
}

}  // namespace

std::optional<double> longest_tick(const LinearLoop& loop, double delay, double tick, double enough) {
  // Ticks far below the delay make a long queue of commands; the loop is as stable as at a tenth of it.
  const double start = std::max(tick / kFarTicks, delay / 10);
  const auto limit = first_unstable(
      [&](double T) {
        return sampled_radius(loop, loop.feedback.gain(), {T, delay});
      },
      start, tick * kFarTicks, stretched, enough);
  return limit == start ? 0 : limit;
}

std::optional<double> first_unstable(const std::function<double(double)>& radius, double start, double end,
                                     const std::function<double(double)>& next, double enough) {
  if (grows(radius(start))) return start;
  for (double stable = start; stable != end;) {
    work_goes_on();
    const bool upwards = end > start;
    const double ahead = upwards ? std::min(next(stable), end) : std::max(next(stable), end);
    if (!grows(radius(ahead))) {
      stable = ahead;
      if (upwards && stable >= enough) return std::nullopt;
      continue;
    }
    double unstable = ahead;
    while (std::abs(unstable - stable) > 1e-7 * std::abs(unstable)) {
      const double middle = (stable + unstable) / 2;
      (grows(radius(middle)) ? unstable : stable) = middle;
    }
    return stable;
  }
  return std::nullopt;
}

std::optional<double> longest_delay(const LinearLoop& loop, double tick, double step, double enough) {
  return first_unstable(
      [&](double delay) {
        return sampled_radius(loop, loop.feedback.gain(), {tick, delay});
      },
      0, kFarDelay * tick, [step](double delay) { return delay + step; }, enough);
}

Limits limits_of(const LinearLoop& loop, const Sampling& sampling) {
  Limits limits;
  const Matrix gain = loop.feedback.gain();
  const Eigen::VectorXcd all = poles(loop, gain);
  Eigen::Index fastest = 0;
  all.cwiseAbs().maxCoeff(&fastest);
  limits.fastest_pole = all[fastest].real();
  limits.radius = sampled_radius(loop, gain, sampling);
  limits.longest_tick = longest_tick(loop, sampling.delay, sampling.tick);
  limits.longest_tick_undelayed =
      sampling.delay > 0 ? longest_tick(loop, 0, sampling.tick) : limits.longest_tick;
  limits.longest_delay = longest_delay(loop, sampling.tick, sampling.tick / 16);
  limits.longest_rk4_step = first_unstable([&](double h) { return rk4_radius(all, h); },
                                           sampling.tick / kFarTicks, sampling.tick * kFarTicks, stretched);
  const auto with_factor = [&](Eigen::Index motor) {
    return [&, motor](double factor) {
      return sampled_radius(loop, scaled_gain(loop.feedback, factor, motor), sampling);
    };
  };
  limits.most_gain = first_unstable(with_factor(-1), 1, kFarGain, stretched);
  limits.least_gain =
      first_unstable(with_factor(-1), 1, 1 / kFarGain, [](double factor) { return factor / kStretch; });
  for (Eigen::Index motor = 0; motor < loop.B.cols(); ++motor)
    limits.most_gain_of_motor.push_back(first_unstable(with_factor(motor), 1, kFarGain, stretched));
  return limits;
}

}  // namespace mixloop
