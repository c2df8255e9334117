// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "dynamics/scene/coordinate_values.hpp"
#include "notation/value.hpp"
#include "plant/faults.hpp"
#include "plant/plant_keys.hpp"

namespace mixloop {
namespace {

using Kind = Fault::Kind;
using Target = Fault::Target;

/// What a fault's magnitude is.
enum class Magnitude : std::uint8_t { none, value, time, share };

Magnitude magnitude_of(Kind kind) {
  switch (kind) {
    case Kind::garbage:
    case Kind::wrong:
      return Magnitude::value;
    case Kind::slow:
    case Kind::delayed:
      return Magnitude::time;
    case Kind::intermittent:
      return Magnitude::share;
    default:
      return Magnitude::none;
  }
}

/// All but the last, which is parameters' and friction's.
std::vector<std::string> kind_words() { return {Fault::kKinds.begin(), Fault::kKinds.end() - 1}; }

class Reader {
 public:
  explicit Reader(const FaultGround& ground) : ground_(ground), scene_(ground.scene) {}

  Fault read(const NodePtr& node) const {
    const Mapping entry = read_mapping(node, fault_keys());
    const NodePtr motor = entry.find("motor"), sensor = entry.find("sensor"),
                  parameter = entry.find("parameter"), friction = entry.find("friction");
    if (!motor + !sensor + !parameter + !friction != 3)
      throw InputError("missing_key", node->place,
                       "a fault is one thing's; expected one of motor, sensor, parameter, friction");
    Fault fault;
    if (motor || sensor)
      read_channel(entry, motor ? motor : sensor, motor != nullptr, fault);
    else
      read_change(entry, parameter, friction, fault);
    fault.at = number_of(*entry.at("at"), kTime, "when a fault begins");
    if (fault.at < 0)
      throw InputError("out_of_range", entry.at("at")->place, "a fault before tick 0; expected 0 s or later");
    if (const NodePtr length = entry.find("for")) {
      fault.duration = number_of(*length, kTime, "how long a fault lasts");
      if (!(fault.duration > 0))
        throw InputError("out_of_range", length->place, "a fault that doesn't last; without 'for' it stays");
      if (first_tick_at(fault.at + fault.duration, ground_.rate_hz) <=
          first_tick_at(fault.at, ground_.rate_hz))
        throw InputError(
            "out_of_range", length->place,
            fmt::format("no tick lies within the {:g} s from {:g} s on; expected a tick ({:g} s) or longer",
                        fault.duration, fault.at, 1 / ground_.rate_hz));
    }
    try {
      require_possible(fault, ground_);
    } catch (const InputError& error) {
      throw InputError(error.code, culprit(entry)->place, error.message);
    }
    return fault;
  }

 private:
  static NodePtr culprit(const Mapping& entry) {
    for (const char* key : {"magnitude", "value", "friction", "parameter", "kind"})
      if (NodePtr node = entry.find(key)) return node;
    return entry.at("at");
  }

  static void refuse(const Mapping& entry, std::initializer_list<const char*> keys, const char* why) {
    for (const char* key : keys)
      if (const NodePtr node = entry.find(key))
        throw InputError("unknown_key", node->place, fmt::format("'{}' {}", key, why));
  }

  /// One's name, its number from 1 (psi_1 in trajectory.csv), or `all`.
  static int read_index(const Node& node, std::span<const Scene::Independent> coordinates) {
    const std::string noun(noun_for(coordinates));
    const std::string& text = text_of(node, "a " + noun);
    if (text.find_first_not_of("0123456789") == std::string::npos)
      return static_cast<int>(
                 whole_number_of(node, 1, static_cast<long>(coordinates.size()), "the number of a " + noun)) -
             1;
    std::vector<std::string> words{"all"};
    for (const auto& coordinate : coordinates) words.push_back(coordinate.name);
    return static_cast<int>(word_of(node, words, "the " + noun)) - 1;
  }

  void read_channel(const Mapping& entry, const NodePtr& which, bool motor, Fault& fault) const {
    refuse(entry, {"value"}, "belongs to a parameter; expected kind and magnitude");
    fault.target = motor ? Target::motor : Target::sensor;
    const auto coordinates =
        motor ? scene_.motors() : std::span<const Scene::Independent>(scene_.independent);
    fault.index = read_index(*which, coordinates);
    fault.kind =
        static_cast<Kind>(word_of(*entry.at("kind"), words_of(fault_keys(), "kind"), "the kind of fault"));
    const Magnitude what = magnitude_of(fault.kind);
    if (what == Magnitude::none) return refuse(entry, {"magnitude"}, "says nothing with this kind of fault");
    const Quantity& wanted = what == Magnitude::time    ? kSeconds
                             : what == Magnitude::share ? kNumber
                             : motor                    ? kTorque
                                                        : kPosition;
    // Of all of them a number with a unit must be each one's.
    const auto whose =
        fault.index < 0 ? coordinates : coordinates.subspan(static_cast<std::size_t>(fault.index), 1);
    for (const auto& one : whose)
      fault.magnitude = number_of(
          *entry.at("magnitude"), wanted.of(one),
          fmt::format("the magnitude of a fault of the {} {} '{}'", one.linear ? "linear" : "rotary",
                      one.driven ? "motor" : "coordinate", one.name));
  }

  void read_change(const Mapping& entry, const NodePtr& parameter, const NodePtr& friction,
                   Fault& fault) const {
    refuse(entry, {"kind", "magnitude"}, "belongs to a motor or sensor");
    fault.kind = Kind::changed;
    if (friction) {
      refuse(entry, {"value"}, "belongs to a parameter; friction has its factor");
      fault.target = Target::friction;
      fault.magnitude = number_of(*friction, kPure, "the factor on friction");
      return;
    }
    fault.target = Target::parameter;
    std::vector<std::string> names;
    for (const auto& known : scene_.parameters) names.push_back(known.name);
    const std::size_t index = word_of(*parameter, names, "the parameter");
    fault.index = static_cast<int>(index);
    if (!may_change(scene_, fault.index))
      throw InputError(
          "out_of_range", parameter->place,
          "the mechanism's geometry depends on '" + names[index] + "', so it can't jump in a run");
    fault.magnitude =
        number_of(*entry.at("value"), scene_.parameters[index].dimension, "the parameter's new value");
  }

  FaultGround ground_;
  const Scene& scene_;
};

}  // namespace

const Keys& fault_keys() {
  static const Keys keys{"a fault",
                         {{"at", form::number(), kRequired},
                          {"for", form::number()},
                          {"motor", form::text()},
                          {"sensor", form::text()},
                          {"parameter", form::text()},
                          {"friction", form::number()},
                          {"kind", form::word(kind_words())},
                          {"magnitude", form::number()},
                          {"value", form::number()}}};
  return keys;
}

std::vector<Fault> read_faults(const NodePtr& node, const Scene& scene, bool friction, double rate_hz,
                               const std::vector<double>& values) {
  const Reader reader({.scene = scene, .friction = friction, .rate_hz = rate_hz, .values = values});
  std::vector<Fault> faults;
  if (node->kind == Node::Kind::empty) return faults;
  if (node->kind != Node::Kind::sequence)
    throw InputError("wrong_kind", node->place, "the faults are " + describe(*node) + "; expected a list");
  for (const auto& item : node->items) faults.push_back(reader.read(item));
  return faults;
}

}  // namespace mixloop
