// SPDX-License-Identifier: MIT
// A log's states and references through the controller again: does it command the same bytes?
#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

#include "commands/commands.hpp"
#include "commands/shared/progress.hpp"
#include "loop/kept_files.hpp"
#include "loop/measured.hpp"
#include "loop/result.hpp"
#include "processes/bus_line.hpp"
#include "processes/controller_side.hpp"
#include "runtime/bus/log_reader.hpp"
#include "runtime/clock/stop_switch.hpp"
#include "runtime/protocol/config_hash.hpp"
#include "watch/tick_assembly.hpp"

namespace mixloop {
namespace {

struct ReplayLine : CommonOptions {
  std::string experiment, log;
  std::string prefix = BusOptions{}.prefix;
  Evaluation evaluation = Evaluation::machine_code;
};

struct Replayed {
  std::int64_t commands = 0;  ///< gone through again
  std::int64_t identical = 0;
  std::int64_t without_inputs = 0;               ///< whose state or reference the log lacks
  std::optional<std::int64_t> first_difference;  ///< tick
};

/// Goes through a log in its order. What it hears is checked as on the bus.
class Replay {
 public:
  Replay(const Experiment& experiment, const Plan& plan, const std::string& prefix)
      : has_path_(plan.has_path()),
        controller_(make_guarded_controller(experiment)),
        side_(controller_side(controller_, experiment, plan)),
        states_(static_cast<int>(measured_coordinates(experiment).size())),
        references_(experiment.scene->n_u()),
        commands_(experiment.scene->n_u()),
        again_(experiment.scene->n_u()),
        names_{prefix + "STATE", prefix + "REFERENCE", prefix + "COMMAND"},
        ticks_({.behind = std::max(TickAssembly::kBehind, farthest_extrapolated(experiment) + 1),
                .config = config_of(common_ground(experiment))}) {
    say_complaint(controller_.law().equations().complaint());
  }

  void take(const LogEvent& event) {
    if (event.channel == names_[0]) keep(states_, event.data);
    if (event.channel == names_[1]) keep(references_, event.data);
    if (event.channel == names_[2]) compare(event.data);
  }
  const Replayed& result() const { return result_; }

  /// Why none of the log's commands could be gone through, for a person.
  std::string why_none(const Experiment& experiment) const {
    if (heard_ == 0)
      return "it has no message on " + names_[2] + "; expected another --channel-prefix, or the log of a run";
    const std::string messages = fmt::format("its {} messages on {} ", heard_, names_[2]);
    if (of_another_type_ > 0)
      return messages +
             "are of another type than mixloop_lcm.command_t; expected a log of mixloop's messages";
    if (of_another_n_ > 0)
      return messages + fmt::format(
                            "are of another number of motors than the experiment's {}; expected the log of a "
                            "run of the same experiment",
                            experiment.scene->n_u());
    if (config_)
      return messages + "are of another experiment: its " +
             name_difference(config_of(common_ground(experiment)), *config_) +
             " differ; expected the log of a run of the same experiment (--set)";
    return messages + "can't be read; expected the log of a run of the same experiment";
  }

 private:
  static std::int64_t farthest_extrapolated(const Experiment& experiment) {
    return std::min<std::int64_t>(experiment.deadline.max_missed, kFarthestExtrapolated);
  }

  template <class Message>
  void keep(Inbox<Message>& inbox, Bytes bytes) {
    if (inbox.read(bytes) || ticks_.add(inbox.message) != Taken::other_session) return;
    // A log may begin with the reference to a tick whose state comes later.
    ticks_.begin(inbox.message.session, inbox.message.seq - TickAssembly::kAhead);
    ticks_.add(inbox.message);
    latest_ = -1;
  }

  void compare(Bytes bytes) {
    ++heard_;
    if (commands_.read(bytes)) {
      const bool is_command = fingerprint(bytes) == command_t::getHash();
      of_another_type_ += !is_command;
      of_another_n_ += is_command && peek(bytes)->n != commands_.message.n;
      return;
    }
    const command_t& logged = commands_.message;
    const Taken taken = ticks_.add(logged);
    if (taken == Taken::other_config) config_ = logged.config;
    if (taken == Taken::other_session || taken == Taken::other_config || logged.seq <= latest_) return;
    const auto* state = ticks_.find<state_t>(logged.seq);
    none_.seq = logged.seq;
    const auto* reference =
        has_path_ ? ticks_.find<reference_t>(logged.seq - extrapolated_by(logged.flags)) : &none_;
    const bool of_the_law = (logged.flags & command_t::FLAG_WITHOUT_REFERENCE) == 0;
    if (latest_ < 0 && state) side_.begin(*state);
    latest_ = logged.seq;
    if (!state || (of_the_law && !reference)) {
      ++result_.without_inputs;
      return;
    }
    command_t& again = again_.message;
    set_header(again, header_of(logged));
    again.utime = state->utime;
    const std::int32_t of_the_peer = std::int32_t{command_t::FLAG_JOINED_LATE} | command_t::FLAG_STOPPED |
                                     command_t::FLAG_WITHOUT_REFERENCE | command_t::FLAG_AFTERWARDS;
    again.flags = (logged.flags & of_the_peer) | answer(*state, of_the_law ? reference : nullptr);
    if ((logged.flags & command_t::FLAG_AFTERWARDS) != 0) again.flags |= make_safe();
    const Bytes encoded = again_.encode();
    ++result_.commands;
    if (std::equal(encoded.begin(), encoded.end(), bytes.begin(), bytes.end()))
      ++result_.identical;
    else if (!result_.first_difference)
      result_.first_difference = logged.seq;
  }

  /// Fills again_ in; null: there was no reference. The flags.
  std::int32_t answer(const state_t& state, const reference_t* reference) {
    auto& tau = again_.message.tau_commanded;
    if (reference == nullptr) return make_safe();
    const std::int64_t ahead = state.seq - reference->seq;
    return side_.compute(state, *reference, ahead, tau) | extrapolation_flags(ahead);
  }

  std::int32_t make_safe() {
    side_.safe(again_.message.tau_commanded);
    return command_t::FLAG_SAFE;
  }

  bool has_path_;
  reference_t none_{};  ///< without a path
  GuardedController controller_;
  ControllerSide side_;
  Inbox<state_t> states_;
  Inbox<reference_t> references_;
  Inbox<command_t> commands_;
  Outbox<command_t> again_;
  std::array<std::string, 3> names_;
  TickAssembly ticks_;
  std::int64_t latest_ = -1;
  std::int64_t heard_ = 0, of_another_type_ = 0, of_another_n_ = 0;  ///< messages where commands should be
  std::optional<std::int64_t> config_;                               ///< of another experiment's
  Replayed result_;
};

int tell(const Replayed& replayed, const std::string& damage, const std::string& note, bool json) {
  const bool held = replayed.commands > 0 && replayed.identical == replayed.commands;
  if (json) {
    nlohmann::json result = {{"commands", replayed.commands},
                             {"identical", replayed.identical},
                             {"without_inputs", replayed.without_inputs},
                             {"damage", damage},
                             {"note", note},
                             {"verdict", held ? "held" : "missed"}};
    if (replayed.first_difference) result["first_difference"] = *replayed.first_difference;
    print_json(result);
    return held ? kHeld : kMissed;
  }
  fmt::print("{} of {} commands are the same bytes again", replayed.identical, replayed.commands);
  if (replayed.first_difference)
    fmt::print("; the first that differs is of tick {}", *replayed.first_difference);
  fmt::print("\n");
  if (replayed.without_inputs > 0)
    fmt::print("  {} more could not be gone through: the log lacks their state or reference\n",
               replayed.without_inputs);
  for (const std::string& line : {damage, note})
    if (!line.empty()) fmt::print("  {}\n", line);
  return held ? kHeld : kMissed;
}

int run(const ReplayLine& options) {
  StopSwitch stop;
  stop.turn_on_signals();
  const ShownWork work(stop);
  Experiment experiment = load_experiment(std::filesystem::path(options.experiment), options.overrides());
  experiment.evaluation = options.evaluation;
  const Plan plan = make_plan(experiment);
  Replay replay(experiment, plan, options.prefix);
  LogReader log(options.log);
  std::set<std::int64_t> sessions;
  while (const LogEvent* event = log.next()) {
    if (stop.turned()) return kInterrupted;
    replay.take(*event);
    if (const auto header = peek(event->data)) sessions.insert(header->session);
  }
  if (replay.result().commands + replay.result().without_inputs == 0)
    throw InputError("no_commands", {options.log}, replay.why_none(experiment));
  const std::string note = foreign_log(result_beside(options.log), options.log, sessions);
  return tell(replay.result(), log.damage(), note, options.json);
}

}  // namespace

void add_replay_command(CLI::App& command, int& status) {
  auto options = std::make_shared<ReplayLine>();
  add_experiment_option(command, options->experiment);
  command.add_option("log", options->log, "an LCM log, as run --out keeps it or lcm-logger writes it")
      ->required()
      ->type_name("LOG");
  add_common_options(command, *options);
  command.add_option("--channel-prefix", options->prefix, "of every channel's name, " + options->prefix)
      ->type_name("PREFIX");
  add_evaluation_option(command, options->evaluation);
  command.footer(
      "Holds (exit 0) when every command that can be gone through again is the same bytes; else exit 1, with "
      "the\n"
      "first tick that differs.\n"
      "Example:\n"
      "  mixloop replay experiments/paper.yaml results/paper/run.lcmlog");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
