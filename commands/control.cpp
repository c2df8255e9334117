// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>

#include "commands/commands.hpp"
#include "loop/result.hpp"
#include "notation/errors.hpp"
#include "plant/faults.hpp"
#include "processes/bus_line.hpp"
#include "processes/speed.hpp"

namespace mixloop {
namespace {

/// fault_t's targets and kinds, in their order.
const std::vector<std::string> kTargets = {"motor", "sensor", "payload", "friction"};
const std::vector<std::string> kKinds(Fault::kKinds.begin(), Fault::kKinds.end());

struct Options {
  BusOptions bus;
  double patience = 5;
  bool json = false;
  std::int64_t steps = 1;
  std::string speed;
  std::string target, kind;
  int index = 0;
  double magnitude = 0, duration = 0;
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
    if (!heard_)
      throw RunFault("lost_peer",
                     "no plant is heard on " + channel_ +
                         "; is it in the same network namespace, with the same --channel-prefix?");
    return *heard_;
  }

 private:
  void on_state(Bytes bytes) {
    const auto header = peek(bytes);
    if (header && header->n > 0 && header->session != 0) heard_ = header;
  }

  std::string channel_;
  std::optional<Header> heard_;
};

int send(const Options& options, std::int8_t action, double speed) {
  StopSwitch stop;
  stop.turn_on_signals();
  Bus bus(options.bus);
  PlantSought plant(bus);
  const Header heard = plant.wait(bus, nanoseconds(static_cast<std::int64_t>(options.patience * 1e9)), stop);
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

int send_fault(const Options& options) {
  StopSwitch stop;
  stop.turn_on_signals();
  Bus bus(options.bus);
  PlantSought plant(bus);
  const Header heard = plant.wait(bus, nanoseconds(static_cast<std::int64_t>(options.patience * 1e9)), stop);
  const auto index = [](const auto& words, const std::string& word) {
    return static_cast<std::int8_t>(std::find(words.begin(), words.end(), word) - words.begin());
  };
  Outbox<fault_t> fault(heard.n);
  Header header = heard;
  header.utime = 0;
  // The clock is a count that grows from call to call.
  header.seq = std::chrono::duration_cast<std::chrono::microseconds>(now()).count();
  set_header(fault.message, header);
  fault.message.target = index(kTargets, options.target);
  fault.message.kind = index(kKinds, options.kind);
  fault.message.index = options.index - 1;
  fault.message.magnitude = options.magnitude;
  fault.message.duration = options.duration;
  fault.encode();
  for (int i = 0; i < 3; ++i) bus.publish(bus.channel("FAULT"), fault.encoded());
  if (options.json)
    print_json({{"session", heard.session}, {"tick", heard.seq}});
  else
    fmt::print(
        "sent to the plant of session {}, at tick {}; it obeys if it was started with --allow-faults\n",
        heard.session, heard.seq);
  return kHeld;
}

/// STOP is honoured from anyone: no plant need be heard.
int send_stop(const Options& options) {
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

void add_control_command(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  auto* command =
      app.add_subcommand("control", "steers a plant that is running: pause, step, speed, reset, stop");
  command->require_subcommand(1);
  const auto add = [&](const char* name, const char* what, std::function<int()> act) {
    auto* sub = command->add_subcommand(name, what);
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
  fault->add_option("target", options->target, "motor, sensor, payload or friction")
      ->required()
      ->check(CLI::IsMember(kTargets));
  fault
      ->add_option("kind", options->kind,
                   "none, off, stuck, garbage, wrong, slow, delayed, intermittent; changed")
      ->required()
      ->check(CLI::IsMember(kKinds));
  fault->add_option("--index", options->index, "which motor, sensor or parameter, from 1; 0: all")
      ->check(CLI::Range(0, 1000));
  fault->add_option("--magnitude", options->magnitude, "in SI, as docs/experiments.md says of the kind");
  fault->add_option("--for", options->duration, "seconds of plant time; 0: until healed")
      ->check(CLI::NonNegativeNumber);
  command->footer(
      "Sends SIM_CONTROL (or STOP) to the plant whose STATE is heard; docs/messages.md says what each does.\n"
      "Example:\n"
      "  mixloop run experiments/paper.yaml --realtime --paused &\n"
      "  mixloop control step 10; mixloop control resume");
}

}  // namespace mixloop
