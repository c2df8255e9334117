// SPDX-License-Identifier: MIT
// What happens on the bus, in a terminal.
#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdlib>

#include "commands/commands.hpp"
#include "commands/runs/screen.hpp"
#include "commands/shared/attached.hpp"
#include "commands/shared/progress.hpp"
#include "loop/result.hpp"
#include "processes/bus_line.hpp"
#include "runtime/bus/bus.hpp"
#include "watch/watch.hpp"
#include "watch/watch_text.hpp"

namespace mixloop {
namespace {

using std::chrono::milliseconds;

struct MonitorLine : CommonOptions {
  std::string experiment;
  BusOptions bus;
  bool once = false, no_colour = false;
  double seconds = 1, patience = 10;
};

nanoseconds nanoseconds_of(double seconds) { return nanoseconds(static_cast<std::int64_t>(seconds * 1e9)); }

/// A watch, with every channel of the bus subscribed to it.
class MonitorListener {
 public:
  MonitorListener(Bus& bus, Watch& watch) {
    for (std::size_t i = 0; i < ears_.size(); ++i) {
      ears_[i] = {&watch, static_cast<Channel>(i)};
      bus.subscribe<&Ear::hear>(bus.channel(kChannelNames[i]), &ears_[i]);
    }
  }

 private:
  struct Ear {
    Watch* watch = nullptr;
    Channel channel{};
    void hear(Bytes bytes) { watch->take(channel, bytes, now()); }
  };
  std::array<Ear, kChannelNames.size()> ears_;
};

Watch make_watch(const MonitorLine& options) {
  std::optional<Experiment> experiment;
  if (!options.experiment.empty())
    experiment = load_experiment(std::filesystem::path(options.experiment), options.overrides());
  return Watch(options.bus.prefix, std::move(experiment), now());
}

/// Listens for a while, or to the run's end, and says what was heard.
int once(const MonitorLine& options, Watch& watch, Bus& bus, const StopSwitch& stop) {
  const Instant give_up = now() + nanoseconds_of(options.patience);
  while (!watch.heard_state() && !stop.turned()) {
    if (now() > give_up) throw no_plant_heard(bus);
    bus.wait(give_up, stop);
  }
  watch.view(now());  // rates are counted from here
  const Instant end = now() + nanoseconds_of(options.seconds);
  while (now() < end && !watch.ended() && !stop.turned()) bus.wait(end, stop);
  const WatchView view = watch.view(now());
  if (options.json)
    print_json(watch_json(view));
  else
    for (const Line& line : whole_watch_lines(view)) fmt::print("{}\n", to_text(line));
  return stop.turned() ? kInterrupted : kHeld;
}

int on_screen(const MonitorLine& options, Watch& watch, Bus& bus, const StopSwitch& stop) {
  const char* no_colour = std::getenv("NO_COLOR");
  Screen screen(!options.no_colour && !(no_colour && *no_colour));
  const std::string keys = "q quits   r forgets the worst   " + options.bus.url;
  Instant drawn{0};
  while (!stop.turned()) {
    if (now() - drawn > milliseconds(200)) {
      drawn = now();
      screen.show(watch_lines(watch.view(drawn), screen.width(), screen.height() - 1), keys);
    }
    const Instant next = now() + milliseconds(50);
    while (now() < next && !stop.turned()) bus.wait(next, stop);
    switch (screen.key()) {
      case Screen::Key::quit:
        return kHeld;
      case Screen::Key::forget:
        watch.forget_the_worst();
        [[fallthrough]];
      case Screen::Key::resized:
        drawn = Instant(0);
        break;
      case Screen::Key::none:
        break;
    }
  }
  return kInterrupted;
}

int run(const MonitorLine& options) {
  StopSwitch stop;
  stop.turn_on_signals();
  const ShownWork work(stop);
  Watch watch = make_watch(options);
  Bus bus(options.bus);
  const MonitorListener listener(bus, watch);
  if (options.once || options.json) return once(options, watch, bus, stop);
  return on_screen(options, watch, bus, stop);
}

}  // namespace

void add_monitor_command(CLI::App& command, int& status) {
  auto options = std::make_shared<MonitorLine>();
  command
      .add_option(
          "experiment", options->experiment,
          "the experiment that runs: gives torque limits, and position errors where TRUTH is not sent")
      ->type_name("EXPERIMENT");
  add_common_options(command, *options);
  command.add_flag("--once", options->once,
                   "print what was heard in --seconds and leave; --json does so too");
  add_seconds_option(command, "--seconds", options->seconds,
                     "to listen with --once or --json, from the first STATE on, or to the run's end; 1",
                     86400);
  add_seconds_option(command, "--patience", options->patience,
                     "seconds to wait for a plant with --once or --json, 10");
  command.add_flag("--no-colour", options->no_colour, "without colours, as with NO_COLOR set");
  add_bus_options(command, options->bus);
  command.footer(
      "By channel: messages a second, time since the last one, ticks that were skipped (lost) or came again\n"
      "(repeated), and what could not be decoded or is not finite (bad). Then the position error, and for "
      "each motor\n"
      "its error (desired less measured) and commanded torque, now and at worst; and times: the plant's own "
      "by\n"
      "MIXLOOP_TIMING, and between messages as they were heard here, this machine's wake-ups included.\n"
      "It only listens. The worst is since it began to listen, without the move to the path's start.\n"
      "Examples:\n"
      "  mixloop monitor                                    # q quits\n"
      "  mixloop monitor experiments/paper.yaml --once      # one look, as text\n"
      "  mixloop monitor --json --seconds 5 | jq '.channels.MIXLOOP_STATE.rate'\n"
      "In the network namespace of a run that holds:\n"
      "  nsenter --preserve-credentials --user --net --target PID mixloop monitor");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
