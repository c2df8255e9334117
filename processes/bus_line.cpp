// SPDX-License-Identifier: MIT
#include "processes/bus_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>

#include "notation/utf8.hpp"
#include "processes/parent.hpp"

namespace mixloop {
namespace {

/// What is wrong with a prefix; empty where nothing is.
std::string unfit_prefix(const std::string& prefix) {
  if (prefix.size() > kLongestPrefix)
    return fmt::format("{} has {} bytes; expected {} at most, which LCM's names of channels leave",
                       in_quotes(prefix), prefix.size(), kLongestPrefix);
  if (first_non_text(prefix)) return in_quotes(prefix) + " is no text; expected letters and digits";
  return {};
}

}  // namespace

void add_bus_options(CLI::App& command, BusOptions& options) {
  if (const char* url = std::getenv("LCM_DEFAULT_URL"); url && *url) options.url = url;
  command.add_option("--lcm-url", options.url, "where the bus is; LCM_DEFAULT_URL, else " + options.url)
      ->type_name("URL");
  command.add_option("--channel-prefix", options.prefix, "of every channel's name, " + options.prefix)
      ->type_name("PREFIX")
      ->check(unfit_prefix);
}

Experiment PeerLine::load() const {
  Experiment loaded = load_experiment(std::filesystem::path(experiment), overrides());
  loaded.evaluation = evaluation;
  if (loaded.plant.continuous)
    throw InputError("out_of_range", {experiment},
                     "plant.control is 'continuous': over the bus a torque is held from tick to tick; "
                     "expected 'held' (mixloop simulate runs both)");
  return loaded;
}

void add_peer_options(CLI::App& command, PeerLine& line) {
  add_experiment_option(command, line.experiment, "the experiment file, the same for all three processes");
  add_common_options(command, line);
  add_bus_options(command, line.bus);
  command
      .add_option("--session", line.session,
                  "the run's id; 0: the plant draws one, the others take the first that they hear")
      ->type_name("ID");
  add_seconds_option(command, "--patience", line.patience,
                     "seconds without an answer after which a peer is lost, 10");
  add_seconds_option(command, "--first-wait", line.first_wait,
                     "seconds to wait for the others at the start, 60", 86400);
  command.add_flag(
      "--realtime", line.real_time,
      "keep real time: locked memory, real-time priority, no deep idle states, where they are allowed");
  command.add_option("--priority", line.wishes.priority, "SCHED_FIFO priority in real time, 80; 0: none")
      ->type_name("P")
      ->check(CLI::Range(0, 98));
  command.add_option("--cpu", line.wishes.cpu, "in real time, the core to stay on")
      ->type_name("CORE")
      ->check(CLI::Range(0, 1023));
  command.add_flag(
      "--spin", line.bus.spin,
      "wait awake, never asleep: saves the wake-up's microseconds and takes a core of its own (--cpu)");
  add_evaluation_option(command, line.evaluation);
  command.add_option_function<pid_t>("--parent", die_with, "by `mixloop run`: its process id")->group("");
}

void PeerLine::say_waiting(const char* program, const char* whom, const char* channel) const {
  fmt::print(stderr, "{}: waiting up to {:g} s for {}, to be heard on {}{} of {}\n", program, first_wait,
             whom, bus.prefix, channel, bus.url);
}

void PeerLine::take_rights(const char* program, bool say, int below) const {
  if (!real_time) return;
  RealTimeWishes mine = wishes;
  if (mine.priority > below) mine.priority -= below;
  for (const auto& lost : take_real_time_rights(mine))
    if (say) fmt::print(stderr, "{}: {}\n", program, lost);
}

}  // namespace mixloop
