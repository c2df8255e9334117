// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/scene/scene.hpp"
#include "notation/document.hpp"
#include "plant/chance.hpp"

namespace mixloop {

/// Something that goes wrong. It begins with the first tick at or after `at` and ends with the first one at
/// or after `at + duration`; on the same target a later fault takes an earlier one's place.
struct Fault {
  /// As fault_t's TARGET constants: what acts, what is measured, a parameter of the scene, friction.
  enum class Target : std::uint8_t { motor, sensor, parameter, friction };
  /// As fault_t's KIND constants.
  enum class Kind : std::uint8_t { none, off, stuck, garbage, wrong, slow, delayed, intermittent, changed };
  static constexpr std::array<std::string_view, 4> kTargets = {"motor", "sensor", "parameter", "friction"};
  static constexpr std::array<std::string_view, 9> kKinds = {
      "none", "off", "stuck", "garbage", "wrong", "slow", "delayed", "intermittent", "changed"};

  Target target = Target::motor;
  Kind kind = Kind::none;  ///< none heals
  int index = -1;          ///< of the motor, sensor or parameter, from 0; -1: all motors or sensors
  double magnitude =
      0;  ///< N m, N, rad, m, s, a share of time, the parameter's value or a factor, as the kind has it
  double at = 0;        ///< s of plant time; what has passed: at once
  double duration = 0;  ///< s; 0: until healed
  bool operator==(const Fault&) const = default;
};

/// What may happen to a plant.
struct FaultSettings {
  std::vector<Fault> scheduled;
  bool injected = false;  ///< more may come by Plant::inject
  bool any() const { return injected || !scheduled.empty(); }
  bool change_friction() const;  ///< they may
  bool random() const;           ///< a scheduled one draws random numbers
};

/// Whether a parameter's change can happen in a run: not where the mechanism's geometry depends on it.
bool may_change(const Scene& scene, int parameter);

/// Whether a kind says something by its magnitude.
bool has_magnitude(Fault::Kind kind);

/// Why a fault can't be, in words; null where it can. Without a scene: in none.
const char* objection(const Fault& fault, const Scene& scene, double rate_hz);
const char* objection(const Fault& fault, double rate_hz);

/// What faults may change: a scene, whether there is friction, the plant's parameters.
struct FaultGround {
  const Scene& scene;
  bool friction = false;
  double rate_hz = 1000;
  const std::vector<double>& values;
};

/// Throws InputError, without a place, where a fault can't be: by its objection, or because nothing would
/// come of it, or nothing physical.
void require_possible(const Fault& fault, const FaultGround& ground);

/// Reads the list `[{at, for, motor | sensor | parameter | friction, kind, magnitude | value}, ...]`.
/// `friction`: there is some that can change; `values`: the plant's parameters.
std::vector<Fault> read_faults(const NodePtr& node, const Scene& scene, bool friction, double rate_hz,
                               const std::vector<double>& values);

/// The first tick at or after a time, s.
std::int64_t first_tick_at(double time, double rate_hz);

/// What goes wrong, when and for how long: "motor psi2 is stuck from 0.3 s on, for 0.2 s".
std::string to_string(const Fault& fault, const Scene& scene);

/// One scalar's way through a fault, tick by tick. Within a tick it may be asked again, with another value:
/// the last one counts.
class FaultFilter {
 public:
  FaultFilter(Chance chance, std::size_t channel, Draw draw, double rate_hz);
  bool operator==(const FaultFilter&) const = default;

  /// From the tick in hand on.
  void start(Fault::Kind kind, double magnitude);
  bool active() const { return kind_ != Fault::Kind::none; }

  double pass(std::int64_t tick, double value);

 private:
  double filtered(double value);

  Chance chance_;
  std::size_t channel_;
  Draw draw_;
  double rate_hz_;
  Fault::Kind kind_ = Fault::Kind::none;
  double magnitude_ = 0;
  std::int64_t tick_ = -1, delay_ = 0, filled_ = 0;
  double out_ = 0, before_ = 0, held_ = 0;  ///< of this tick, at the last one's end, when the fault began
  bool begun_ = false;                      ///< the fault has met its first value
  std::vector<double> ring_;                ///< of kind delayed, by tick
};

/// The faults of a plant: what may come about, and when. Nothing allocates but state().
class Faults {
 public:
  /// So many injected faults may wait for their time.
  static constexpr std::size_t kWaiting = 64;
  /// The longest dead time of a fault, s; at fast rates less.
  static constexpr double kLongestDelay = 1;
  static double longest_delay(double rate_hz);

  /// What has come about, and what is still to come.
  struct State {
    struct Scheduled {
      std::int64_t tick;
      Fault fault;
      bool operator==(const Scheduled&) const = default;
    };
    std::vector<Scheduled> waiting;  ///< in the order of their ticks
    std::vector<FaultFilter> motors, positions, velocities;
    std::vector<std::int64_t> until;  ///< of motors, sensors, parameters, friction: the tick that ends it
    std::vector<double> parameters;   ///< of the scene
    double friction = 1;              ///< a factor
    bool active = false;              ///< anything, at the tick last begun
    std::int64_t changed_at = -1;     ///< the last tick at which parameters or friction changed; -1
    bool operator==(const State&) const = default;
  };

  /// `values`: the plant's parameters as it begins.
  Faults(const FaultSettings& settings, std::uint64_t seed, const Scene& scene, double rate_hz,
         std::vector<double> values);

  /// Before any tick, with room for all that may wait.
  State state() const;

  /// Whether it ends what is wrong, now: what no limit is in the way of.
  bool heals_at_once(const Fault& fault, std::int64_t tick) const {
    return fault.kind == Fault::Kind::none && tick_at(fault.at) <= tick;
  }
  /// Whether something is wrong with what a fault is about.
  bool is_wrong(const State& state, const Fault& fault) const;
  /// Whether no more injected ones can wait for their time beside `more`.
  bool full(const State& state, std::size_t more = 0) const {
    return state.waiting.size() + more >= scheduled_.size() + kWaiting;
  }

  /// False: it can't be, or too many wait.
  bool inject(State& state, const Fault& fault, const Scene& scene, std::int64_t tick) const;
  /// Begins and ends what is due.
  void begin(State& state, std::int64_t tick) const;

 private:
  void queue(State& state, const Fault& fault, std::int64_t earliest) const;
  Fault healing(std::size_t slot) const;
  /// True where parameters or friction change.
  bool start(State& state, const Fault& fault, std::int64_t until) const;
  bool any_active(const State& state) const;
  std::int64_t tick_at(double time) const { return first_tick_at(time, rate_hz_); }

  std::vector<Fault> scheduled_;
  Chance chance_;
  double rate_hz_;
  std::size_t n_, n_u_;
  std::vector<double> normal_;  ///< the parameters where nothing is wrong
};

}  // namespace mixloop
