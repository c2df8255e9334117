// SPDX-License-Identifier: MIT
#include "plant/actuators.hpp"

#include <algorithm>
#include <cmath>

#include "notation/value.hpp"
#include "plant/plant_keys.hpp"
#include "plant/read_each.hpp"

namespace mixloop {
namespace {

constexpr double kSmallest = 1e-300;
constexpr double kSmooth = 0.1;  // rad/s or m/s
constexpr Range kPositive{kSmallest, kNoLimit, "a positive value"}, kNotNegative{0, kNoLimit, "0 or more"};

const Keys& ripple_keys() {
  static const Keys keys{
      "the torque ripple",
      {{"amplitude", form::numbers(), kRequired}, {"per_turn", form::numbers(), kRequired}}};
  return keys;
}

const Keys& drive_friction_keys() {
  static const Keys keys{
      "the drives' friction",
      {{"viscous", form::numbers()}, {"coulomb", form::numbers()}, {"smooth", form::numbers()}}};
  return keys;
}

void read_ripple(const NodePtr& node, const Scene& scene, ActuatorSettings& settings) {
  const Mapping entry = read_mapping(node, ripple_keys());
  settings.ripple = read_each(entry.at("amplitude"), scene.motors(), kNumber,
                              {0, 1, "0 to 1, a share of the torque"}, "the ripple's amplitude");
  settings.ripple_per_turn =
      read_each(entry.at("per_turn"), scene.motors(), kNumber, kPositive, "the ripple's periods per turn");
  for (std::size_t i = 0; i < scene.motors().size(); ++i)
    if (scene.motors()[i].linear && settings.ripple[i] > 0)
      throw InputError("out_of_range", entry.at("amplitude")->place,
                       "the linear motor '" + scene.motors()[i].name +
                           "' has no turns for a ripple to go with; expected an amplitude of 0");
}

void read_friction(const NodePtr& node, const Scene& scene, ActuatorSettings& settings) {
  const Mapping entry = read_mapping(node, drive_friction_keys());
  settings.viscous =
      read_each(entry.find("viscous"), scene.motors(), kTorque / kVelocity, kNotNegative, "viscous friction");
  settings.coulomb =
      read_each(entry.find("coulomb"), scene.motors(), kTorque, kNotNegative, "Coulomb friction");
  const NodePtr smooth = entry.find("smooth");
  if (smooth && settings.coulomb.empty())
    throw InputError("unknown_key", smooth->place, "smooth belongs to coulomb, and there is none");
  settings.smooth = read_each(smooth, scene.motors(), kVelocity, kPositive,
                              "the velocity up to which Coulomb friction is smooth");
  if (settings.smooth.empty() && !settings.coulomb.empty())
    settings.smooth.assign(scene.motors().size(), kSmooth);
}

}  // namespace

const Keys& actuator_keys() {
  static const Keys keys{"the actuators",
                         {{"rate_limit", form::numbers()},
                          {"time_constant", form::numbers()},
                          {"ripple", form::mapping(ripple_keys)},
                          {"friction", form::mapping(drive_friction_keys)}}};
  return keys;
}

ActuatorSettings read_actuator_settings(const NodePtr& node, const Scene& scene) {
  const Mapping entry = read_mapping(node, actuator_keys());
  ActuatorSettings settings;
  settings.rate_limit =
      read_each(entry.find("rate_limit"), scene.motors(), kTorque / kSeconds, kPositive, "the rate limit");
  settings.time_constant =
      read_each(entry.find("time_constant"), scene.motors(), kSeconds, kNotNegative, "the time constant");
  if (const NodePtr ripple = entry.find("ripple")) read_ripple(ripple, scene, settings);
  if (const NodePtr friction = entry.find("friction")) read_friction(friction, scene, settings);
  return settings;
}

Actuators::Actuators(const ActuatorSettings& settings, std::size_t n_u) {
  const auto value = [](const std::vector<double>& values, std::size_t i, double otherwise) {
    return values.empty() ? otherwise : values[i];
  };
  for (std::size_t i = 0; i < n_u; ++i)
    drives_.push_back({.rate = value(settings.rate_limit, i, HUGE_VAL),
                       .lag = value(settings.time_constant, i, 0),
                       .ripple = value(settings.ripple, i, 0),
                       .per_turn = value(settings.ripple_per_turn, i, 0),
                       .viscous = value(settings.viscous, i, 0),
                       .coulomb = value(settings.coulomb, i, 0),
                       .smooth = value(settings.smooth, i, kSmooth)});
}

double Actuators::Drive::ramp_time(const State::Drive& at) const { return std::abs(at.u - at.r) / rate; }

// r(s) = r0 + sign(u - r0) min(R s, |u - r0|)
double Actuators::Drive::ramp(const State::Drive& from, double s) const {
  const auto [u, r, y] = from;
  return s >= ramp_time(from) ? u : r + std::copysign(rate * s, u - r);
}

// T y' = r - y. On the ramp, with slope k: y = r0 + k (s + T (e^(-s/T) - 1)) + (y0 - r0) e^(-s/T), and at its
// end towards u from there.
double Actuators::Drive::lagged(const State::Drive& from, double s) const {
  if (lag == 0) return ramp(from, s);
  const auto [u, r, y] = from;
  const double end = ramp_time(from), on_ramp = std::min(s, end), slope = std::copysign(rate, u - r);
  double at = y;
  if (on_ramp > 0)
    at = r + slope * (on_ramp + lag * std::expm1(-on_ramp / lag)) + (y - r) * std::exp(-on_ramp / lag);
  return s > end ? u + (at - u) * std::exp(-(s - end) / lag) : at;
}

double Actuators::Drive::less_friction(double torque, double psid, double factor) const {
  torque -= factor * viscous * psid;
  if (coulomb > 0) torque -= factor * coulomb * std::tanh(psid / smooth);
  return torque;
}

void Actuators::take(State& state, std::span<const double> u) {
  for (std::size_t i = 0; i < state.drives.size(); ++i) {
    auto& drive = state.drives[i];
    drive.u = u[i];
    if (!state.settled) drive.r = drive.y = u[i];
  }
  state.settled = true;
}

void Actuators::torque(const State& state, double s, std::span<const double> psi,
                       std::span<const double> psid, double friction, std::span<double> tau) const {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const Drive& drive = drives_[i];
    double torque = drive.lagged(state.drives[i], s);
    if (drive.ripple > 0) torque *= 1 + drive.ripple * std::sin(drive.per_turn * psi[i]);
    tau[i] = drive.less_friction(torque, psid[i], friction);
  }
}

void Actuators::add_friction(std::span<const double> psid, std::span<double> tau) const {
  for (std::size_t i = 0; i < drives_.size(); ++i) tau[i] = drives_[i].less_friction(tau[i], psid[i], 1);
}

void Actuators::friction_slopes(std::span<const double> psid, std::span<double> slopes) const {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const Drive& drive = drives_[i];
    slopes[i] = -drive.viscous;
    if (drive.coulomb > 0) {
      const double share = std::tanh(psid[i] / drive.smooth);
      slopes[i] -= drive.coulomb / drive.smooth * (1 - share) * (1 + share);
    }
  }
}

void Actuators::pass(State& state, double s) const {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    auto& at = state.drives[i];
    at.y = drives_[i].lagged(at, s);
    at.r = drives_[i].ramp(at, s);
  }
}

double Actuators::next_kink(const State& state, double s) const {
  double next = HUGE_VAL;
  for (std::size_t i = 0; i < drives_.size(); ++i)
    if (const double end = drives_[i].ramp_time(state.drives[i]); drives_[i].lag == 0 && end > s)
      next = std::min(next, end);
  return next;
}

}  // namespace mixloop
