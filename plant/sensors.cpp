// SPDX-License-Identifier: MIT
#include "plant/sensors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "notation/nearest.hpp"
#include "notation/utf8.hpp"
#include "notation/value.hpp"
#include "plant/plant_keys.hpp"
#include "plant/read_each.hpp"

namespace mixloop {
namespace {

constexpr Range kNotNegative{0, kNoLimit, "0 or more"};
constexpr double kLongestDelay = 1;  // s
constexpr std::int64_t kMostTicksOld = 10000;

std::vector<std::int64_t> whole_ticks(const NodePtr& node, const Scene& scene, double rate_hz) {
  std::vector<std::int64_t> ticks;
  const auto delays =
      read_each(node, scene.independent, kSeconds, {0, kLongestDelay, "0 to 1 s"}, "the sensors' delay");
  for (const double delay : delays) {
    const double exactly = delay * rate_hz;
    ticks.push_back(std::llround(exactly));
    if (std::abs(exactly - std::round(exactly)) > 1e-9 * std::max(1.0, exactly))
      throw InputError("out_of_range", node->place,
                       fmt::format("the sensors' delay is {:g} ticks; expected whole ticks of {:g} s",
                                   exactly, 1 / rate_hz));
    if (ticks.back() > kMostTicksOld)
      throw InputError(
          "out_of_range", node->place,
          fmt::format("the sensors' delay is {} ticks; expected up to {}", ticks.back(), kMostTicksOld));
  }
  return ticks;
}

/// The free coordinates that the list doesn't name.
std::vector<int> unmeasured(const NodePtr& node, const Scene& scene) {
  if (!node) return {};
  const std::size_t n_u = scene.motors().size();
  std::vector<std::string> names;
  for (std::size_t i = n_u; i < scene.independent.size(); ++i) names.push_back(scene.independent[i].name);
  std::vector<bool> named(names.size(), false);
  for (const auto& item : items_of(node, "the free coordinates that are measured")) {
    const std::string& name = text_of(*item, "a free coordinate's name");
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end())
      throw InputError("undefined_symbol", item->place,
                       in_quotes(name) + " is no free coordinate of the scene; motors are always measured" +
                           suggestion(name, names));
    const auto index = static_cast<std::size_t>(at - names.begin());
    if (named[index]) throw InputError("doubly_defined", item->place, in_quotes(name) + " is listed twice");
    named[index] = true;
  }
  std::vector<int> others;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!named[i]) others.push_back(static_cast<int>(n_u + i));
  return others;
}

}  // namespace

std::vector<int> SensorSettings::measured(std::size_t n) const {
  std::vector<int> all;
  for (int i = 0; i < static_cast<int>(n); ++i)
    if (std::find(unmeasured.begin(), unmeasured.end(), i) == unmeasured.end()) all.push_back(i);
  return all;
}

const Keys& sensor_keys() {
  static const Keys keys{"the sensors",
                         {{"free", form::list(form::text())},
                          {"resolution", form::numbers()},
                          {"noise", form::numbers()},
                          {"bias", form::numbers()},
                          {"delay", form::numbers()},
                          {"drop", form::numbers()},
                          {"velocity", form::word({"measured", "differentiated"})},
                          {"velocity_filter", form::number()}}};
  return keys;
}

SensorSettings read_sensor_settings(const NodePtr& node, const Scene& scene, double rate_hz) {
  const Mapping entry = read_mapping(node, sensor_keys());
  const auto positions = [&](const char* key, const Range& range, const char* what) {
    return read_each(entry.find(key), scene.independent, kPosition, range, what);
  };
  SensorSettings settings;
  settings.unmeasured = unmeasured(entry.find("free"), scene);
  settings.resolution = positions("resolution", kNotNegative, "the resolution");
  settings.noise = positions("noise", kNotNegative, "the noise");
  settings.bias = positions("bias", {-kNoLimit, kNoLimit, "a finite value"}, "the bias");
  settings.delay = whole_ticks(entry.find("delay"), scene, rate_hz);
  settings.drop = read_each(entry.find("drop"), scene.independent, kNumber, {0, 1, "a probability, 0 to 1"},
                            "the share of readings that are dropped");
  if (const NodePtr velocity = entry.find("velocity"))
    settings.differentiated = word_of(*velocity, words_of(sensor_keys(), "velocity"), "the velocity") == 1;
  if (const NodePtr filter = entry.find("velocity_filter")) {
    if (!settings.differentiated)
      throw InputError("unknown_key", filter->place, "velocity_filter belongs to velocity: differentiated");
    settings.velocity_filter = number_of(*filter, kFrequency, "the velocity's low-pass");
    if (!(settings.velocity_filter > 0))
      throw InputError("out_of_range", filter->place,
                       fmt::format("the velocity's low-pass is {:g} Hz; expected a positive frequency",
                                   settings.velocity_filter));
  }
  return settings;
}

Sensors::Sensors(const SensorSettings& settings, std::uint64_t seed, std::size_t n, double rate_hz)
    : chance_(seed),
      rate_hz_(rate_hz),
      differentiated_(settings.differentiated),
      // T y' = u - y over a tick, T = 1 / (2 pi f)
      share_(settings.velocity_filter > 0
                 ? -std::expm1(-2 * std::numbers::pi * settings.velocity_filter / rate_hz)
                 : 1) {
  const auto value = [](const auto& values, std::size_t i) { return values.empty() ? 0 : values[i]; };
  for (const int measured : settings.measured(n)) {
    const auto i = static_cast<std::size_t>(measured);
    channels_.push_back({.coordinate = i,
                         .resolution = value(settings.resolution, i),
                         .noise = value(settings.noise, i),
                         .bias = value(settings.bias, i),
                         .drop = value(settings.drop, i),
                         .delay = static_cast<std::size_t>(value(settings.delay, i))});
  }
}

Sensors::State Sensors::state() const {
  State state;
  for (const Channel& channel : channels_) {
    const std::vector<double> ring(channel.delay + 1);
    state.channels.push_back({.positions = ring, .velocities = ring});
  }
  return state;
}

bool Sensors::measure(State& state, std::int64_t tick, std::span<const double> psi,
                      std::span<const double> psid, Faults::State* faults, std::span<double> psi_out,
                      std::span<double> psid_out) const {
  const bool again = tick == state.tick;
  if (!again) state.stale = false;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const std::size_t of = channels_[i].coordinate;
    if (!again && read(state, i, tick, psi[of], psid[of], faults)) state.stale = true;
    psi_out[i] = state.channels[i].position;
    psid_out[i] = state.channels[i].velocity;
  }
  state.tick = tick;
  return state.stale;
}

bool Sensors::read(State& state, std::size_t i, std::int64_t tick, double psi, double psid,
                   Faults::State* faults) const {
  const Channel& channel = channels_[i];
  const std::size_t of = channel.coordinate;
  State::Channel& memory = state.channels[i];
  const bool first = state.tick < 0;
  double position = psi + channel.bias;
  if (channel.noise > 0) position += channel.noise * chance_.normal(tick, of, Draw::noise);
  if (channel.resolution > 0) position = channel.resolution * std::nearbyint(position / channel.resolution);
  if (faults) position = faults->positions[of].pass(tick, position);
  double velocity = psid;
  if (differentiated_) {
    const double difference = first ? 0 : (position - memory.before) * rate_hz_;
    memory.filtered = share_ < 1 ? memory.filtered + share_ * (difference - memory.filtered) : difference;
    velocity = memory.filtered;
    memory.before = position;
  } else if (faults) {
    velocity = faults->velocities[of].pass(tick, velocity);
  }
  const std::size_t size = channel.delay + 1, slot = static_cast<std::size_t>(tick) % size;
  if (first) {
    std::fill(memory.positions.begin(), memory.positions.end(), position);
    std::fill(memory.velocities.begin(), memory.velocities.end(), velocity);
  }
  memory.positions[slot] = position;
  memory.velocities[slot] = velocity;
  if (!first && channel.drop > 0 && chance_.uniform(tick, of, Draw::drop) < channel.drop) return true;
  memory.position = memory.positions[(slot + 1) % size];  // the oldest
  memory.velocity = memory.velocities[(slot + 1) % size];
  return false;
}

}  // namespace mixloop
