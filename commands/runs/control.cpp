// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>

#include "commands/commands.hpp"
#include "loop/result.hpp"
#include "notation/errors.hpp"
#include "notation/long_work.hpp"
#include "plant/faults.hpp"
#include "processes/bus_line.hpp"
#include "processes/speed.hpp"
#include "runtime/protocol/real_time_plant.hpp"

namespace mixloop {
namespace {

/// fault_t's targets and kinds. The payload is a parameter, found by its name.
const std::map<std::string, std::int8_t> kTargets = {{"motor", fault_t::TARGET_MOTOR},
                                                     {"sensor", fault_t::TARGET_SENSOR},
                                                     {"parameter", fault_t::TARGET_PARAMETER},
                                                     {"payload", fault_t::TARGET_PAYLOAD},
                                                     {"friction", fault_t::TARGET_FRICTION}};
const std::vector<std::string> kKinds(Fault::kKinds.begin(), Fault::kKinds.end());

struct ControlLine {
  BusOptions bus;
  double patience = 5;
  bool json = false;
  std::int64_t steps = 1;
  std::string speed;
  std::string target, kind;
  int index = 0;
  std::optional<double> magnitude;
  double duration = 0;
};

/// Hears which plant there is, so that it can be told something.
class PlantSought {
 public:
  explicit PlantSought(Bus& bus) : channel_(bus.channel("STATE")) {
    bus.subscribe<&PlantSought::on_state>(channel_, this);
  }

  /// Waits for a STATE. Throws RunFault("lost_peer").
  const Header& wait(Bus& bus, nanoseconds patience, const StopSwitch& stop) {
    for (const Instant until = now() + patience; !heard_ && now() < until && !stop.turned();)
      bus.wait(until, stop);
    if (stop.turned()) throw Interrupted("interrupted");
    if (!heard_)
      throw RunFault("lost_peer",
                     "no plant is heard on " + channel_ +
                         "; is it in the same network namespace, with the same --channel-prefix?");
    return *heard_;
  }
  bool real_time() const { return real_time_; }  ///< it keeps

 private:
  void on_state(Bytes bytes) {
    const auto header = peek(bytes);
    if (!header || header->n < 0 || header->n > kMost || header->session == 0 || header->seq < 0) return;
    // Length and type are looked at before anything is taken for as many coordinates as it claims.
    Inbox<state_t> inbox(header->n);
    if (inbox.read(bytes)) return;
    const state_t& state = inbox.message;
    heard_ = header;
    real_time_ = (state.flags & state_t::FLAG_REAL_TIME) != 0;
  }

  static constexpr std::int32_t kMost = 4096;  ///< coordinates: no datagram holds more

  std::string channel_;
  std::optional<Header> heard_;
  bool real_time_ = false;
};

int send(const ControlLine& options, std::int8_t action, double speed) {
  StopSwitch stop;
  stop.turn_on_signals();
  Bus bus(options.bus);
  PlantSought plant(bus);
  const Header heard = plant.wait(bus, nanoseconds(static_cast<std::int64_t>(options.patience * 1e9)), stop);
  if (action == sim_control_t::ACTION_SPEED && plant.real_time()) require_real_time_speed(speed);
  Outbox<sim_control_t> control(heard.n);
  Header header = heard;
  header.utime = 0;
  header.seq = action == sim_control_t::ACTION_STEP ? options.steps : 0;
  set_header(control.message, header);
  control.message.action = action;
  control.message.speed = speed;
  control.encode();
  // All but steps mean the same however often they are heard.
  const int times = action == sim_control_t::ACTION_STEP ? 1 : 3;
  for (int i = 0; i < times; ++i) bus.publish(bus.channel("SIM_CONTROL"), control.encoded());
  if (options.json)
    print_json({{"session", heard.session}, {"tick", heard.seq}});
  else
    fmt::print("sent to the plant of session {}, at tick {}\n", heard.session, heard.seq);
  return kHeld;
}

/// The message, as far as the line says it. Throws InputError where no plant could take it.
fault_t fault_on(const ControlLine& options) {
  fault_t fault{};
  fault.target = kTargets.at(options.target);
  fault.kind =
      static_cast<std::int8_t>(std::find(kKinds.begin(), kKinds.end(), options.kind) - kKinds.begin());
  fault.index = options.index - 1;
  fault.magnitude = options.magnitude.value_or(0);
  fault.duration = options.duration;
  const auto kind = static_cast<Fault::Kind>(fault.kind);
  const auto refuse = [](const char* option, const std::string& why) {
    throw InputError("out_of_range", {option}, why);
  };
  if (options.target == "parameter" && options.index == 0)
    refuse("--index", "a parameter is meant by its number; expected --index 1 or more, in the scene's order");
  if (has_magnitude(kind) && !options.magnitude)
    refuse("--magnitude",
           "kind " + options.kind + " says nothing without one; expected --magnitude X, in SI");
  if (!has_magnitude(kind) && options.magnitude)
    refuse("--magnitude", "kind " + options.kind + " has none; expected it without");
  const Fault meant{.target = static_cast<Fault::Target>(fault.target),
                    .kind = kind,
                    .index = options.target == "payload" ? std::max(fault.index, 0) : fault.index,
                    .magnitude = fault.magnitude,
                    .duration = fault.duration};
  if (const char* reason = objection(meant, 1)) refuse("control fault", reason);
  return fault;
}

/// Hears what the plant makes of a fault.
class FaultAnswer {
 public:
  FaultAnswer(Bus& bus, const fault_t& fault) : fault_(fault), inbox_(fault.n) {
    bus.subscribe<&FaultAnswer::on_fault>(bus.channel("FAULT"), this);
  }

  /// KIND_TAKEN, KIND_REFUSED or KIND_NOT_ALLOWED; nothing where no answer comes.
  std::optional<std::int8_t> wait(Bus& bus, const StopSwitch& stop) {
    for (const Instant until = now() + kAnswerWait; !heard_ && now() < until && !stop.turned();)
      bus.wait(until, stop);
    return heard_;
  }

 private:
  static constexpr auto kAnswerWait = std::chrono::milliseconds(500);

  void on_fault(Bytes bytes) {
    if (inbox_.read(bytes)) return;
    const fault_t& m = inbox_.message;
    if (m.session == fault_.session && m.seq == fault_.seq && m.kind < fault_t::KIND_NONE) heard_ = m.kind;
  }

  const fault_t& fault_;
  Inbox<fault_t> inbox_;
  std::optional<std::int8_t> heard_;
};

std::string what_became_of(std::optional<std::int8_t> answer) {
  if (answer == fault_t::KIND_TAKEN) return "which has taken it";
  if (answer == fault_t::KIND_NOT_ALLOWED) return "which does not obey: start it with --allow-faults";
  return "which does not say what it made of it";
}

int send_fault(const ControlLine& options) {
  const fault_t meant = fault_on(options);
  StopSwitch stop;
  stop.turn_on_signals();
  Bus bus(options.bus);
  PlantSought plant(bus);
  Header header = plant.wait(bus, nanoseconds(static_cast<std::int64_t>(options.patience * 1e9)), stop);
  const std::int64_t tick = header.seq;
  Outbox<fault_t> fault(header.n);
  fault.message = meant;
  header.utime = 0;
  // The clock is a count that grows from call to call.
  header.seq = std::chrono::duration_cast<std::chrono::microseconds>(now()).count();
  set_header(fault.message, header);
  FaultAnswer heard(bus, fault.message);
  fault.encode();
  for (int i = 0; i < 3; ++i) bus.publish(bus.channel("FAULT"), fault.encoded());
  const auto answer = heard.wait(bus, stop);
  if (answer == fault_t::KIND_REFUSED)
    throw RunFault("refused", fmt::format("the plant of session {} refused it, at tick {}: what "
                                          "mixloop-plant (or mixloop run) prints says why",
                                          header.session, tick));
  if (options.json)
    print_json({{"session", header.session}, {"tick", tick}, {"taken", answer == fault_t::KIND_TAKEN}});
  else
    fmt::print("sent to the plant of session {}, at tick {}, {}\n", header.session, tick,
               what_became_of(answer));
  return kHeld;
}

/// STOP is honoured from anyone: no plant need be heard.
int send_stop(const ControlLine& options) {
  Bus bus(options.bus);
  Outbox<stop_t> message(0);
  message.encode();
  for (int i = 0; i < 3; ++i) bus.publish(bus.channel("STOP"), message.encoded());
  if (options.json)
    print_json({{"sent", bus.channel("STOP")}});
  else
    fmt::print("sent on {}\n", bus.channel("STOP"));
  return kHeld;
}

}  // namespace

void add_control_command(CLI::App& command, int& status) {
  auto options = std::make_shared<ControlLine>();
  command.require_subcommand(1);
  const auto add = [&](const char* name, const char* what, std::function<int()> act) {
    auto* sub = command.add_subcommand(name, what);
    add_bus_options(*sub, options->bus);
    add_seconds_option(*sub, "--patience", options->patience, "seconds to listen for the plant, 5");
    sub->add_flag("--json", options->json, "print one JSON object on stdout and nothing else");
    sub->callback([act, &status] { status = act(); });
    return sub;
  };
  add("pause", "plant time stands still",
      [options] { return send(*options, sim_control_t::ACTION_PAUSE, 0); });
  add("resume", "plant time goes on", [options] { return send(*options, sim_control_t::ACTION_RESUME, 0); });
  add("step", "goes on by some ticks, then stands still again",
      [options] { return send(*options, sim_control_t::ACTION_STEP, 0); })
      ->add_option("ticks", options->steps, "how many, 1")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000'000}));
  add("speed", "another speed from the next tick on",
      [options] { return send(*options, sim_control_t::ACTION_SPEED, speed_of(options->speed)); })
      ->add_option("x", options->speed, "plant seconds a real second; in lockstep also max")
      ->required();
  add("reset", "back to tick 0 in a new session, out of the safe state",
      [options] { return send(*options, sim_control_t::ACTION_RESET, 0); });
  add("stop", "ends the run: whoever hears it stops, whatever session it is of",
      [options] { return send_stop(*options); });
  auto* fault = add("fault", "something goes wrong in the plant, or is well again (kind none)",
                    [options] { return send_fault(*options); });
  fault->add_option("target", options->target, "motor, sensor, parameter, payload (a parameter) or friction")
      ->required()
      ->check(CLI::IsMember(kTargets));
  fault
      ->add_option("kind", options->kind,
                   "none, off, stuck, garbage, wrong, slow, delayed, intermittent of motors and sensors; "
                   "changed, none "
                   "of the others")
      ->required()
      ->check(CLI::IsMember(kKinds));
  fault
      ->add_option("--index", options->index,
                   "which motor, sensor or parameter, from 1 in the scene's order; 0: all motors or sensors, "
                   "the parameter that is called payload")
      ->check(CLI::Range(0, 1000));
  fault->add_option("--magnitude", options->magnitude, "in SI, as docs/experiments.md says of the kind");
  fault->add_option("--for", options->duration, "seconds of plant time; 0: until healed")
      ->check(CLI::NonNegativeNumber);
  command.footer(
      "Sends SIM_CONTROL (or STOP) to the plant whose STATE is heard; docs/messages.md says what each does.\n"
      "Example:\n"
      "  mixloop run experiments/paper.yaml --realtime --paused &\n"
      "  mixloop control step 10; mixloop control resume\n"
      "  mixloop control fault payload changed --magnitude 2     # of a run with --allow-faults");
}

}  // namespace mixloop
