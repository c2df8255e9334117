// SPDX-License-Identifier: MIT

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <charconv>
#include <thread>

#include "commands/commands.hpp"
#include "commands/modules.hpp"
#include "commands/swept.hpp"
#include "notation/utf8.hpp"
#include "notation/value.hpp"
#include "notation/words.hpp"
#include "processes/called_as.hpp"
#include "processes/command_line.hpp"
#include "report/progress.hpp"
#include "sweep/kernel/closed_loops.hpp"
#include "sweep/leading.hpp"
#include "sweep/sweep.hpp"
#include "sweep/written_run.hpp"

namespace mixloop {
namespace {

struct SweepLine : CommonOptions {
  std::string file, case_name;
  std::vector<std::string> vary, sample;
  std::optional<std::int64_t> runs, write_run;
  std::optional<std::uint64_t> seed;
  std::string design, shard, settled_within;
  bool hashes = false;
  SweepOptions how;
  Evaluation evaluation = Evaluation::machine_code;
};

/// The line again, without where it is kept and by whom it is run.
std::string called(const SweepLine& line) {
  std::string text = "mixloop sweep " + shell_word(line.file);
  const auto add = [&](const char* option, const std::string& value) {
    text += fmt::format(" {} {}", option, shell_word(value));
  };
  if (!line.case_name.empty()) add("--case", line.case_name);
  for (const auto& one : line.sets) add("--set", one);
  for (const auto& one : line.vary) add("--vary", one);
  for (const auto& one : line.sample) add("--sample", one);
  if (line.runs) add("--runs", std::to_string(*line.runs));
  if (!line.design.empty()) add("--design", line.design);
  if (line.seed) add("--seed", std::to_string(*line.seed));
  if (!line.settled_within.empty()) add("--settled-within", line.settled_within);
  if (line.hashes) text += " --hashes";
  if (line.evaluation == Evaluation::reference) add("--evaluation", "reference");
  return text;
}

/// What the file asks for, if it is a sweep's, with what the line says on top.
SweepRequest request_of(SweepLine& line) {
  SweepRequest request;
  const std::string asked = called(line);
  if (is_sweep(line.file)) {
    request = read_sweep(line.file);
  } else {
    line.take_case(line.file, line.case_name);
    request.experiment = line.file;
  }
  request.called = asked;
  for (const Override& one : line.overrides()) request.overrides.push_back(one);
  for (const auto& text : line.vary) request.design.varied.push_back(parse_varied(text));
  for (const auto& text : line.sample) request.design.sampled.push_back(parse_sampled(text));
  if (line.runs) request.design.draws = *line.runs, request.draws_given = true;
  if (line.seed) request.design.seed = *line.seed;
  if (!line.design.empty()) {
    const auto spread = spread_named(line.design);
    request.spread_given = spread.has_value();
    if (spread) request.design.spread = *spread;
    if (!spread && !request.design.sampled.empty())
      throw InputError("out_of_range", {"--design grid"},
                       "a grid is of what is listed (--vary), and what is sampled has none; expected latin, "
                       "sobol or random");
  }
  if (!line.settled_within.empty())
    request.settled_within = number_of(*parse_document(line.settled_within, "--settled-within"), kLength,
                                       "what counts as settled");
  return request;
}

/// `3/8`: the third of eight.
Part part_of(const std::string& text) {
  if (text.empty()) return {};
  Part part;
  const char* const end = text.data() + text.size();
  const auto [slash, bad_index] = std::from_chars(text.data(), end, part.index);
  const bool has_slash = bad_index == std::errc() && slash != end && *slash == '/';
  const auto [last, bad_of] = std::from_chars(has_slash ? slash + 1 : end, end, part.of);
  if (!has_slash || bad_of != std::errc() || last != end || part.index < 1 || part.index > part.of)
    throw InputError("out_of_range", {"--shard"},
                     in_quotes(text) + " is no shard; expected I/N, e.g. 3/8 for the third of eight");
  --part.index;
  return part;
}

int write_one(const SweepLine& line, const Sweep& sweep) {
  if (*line.write_run < 0 || *line.write_run >= sweep.runs())
    throw InputError("out_of_range", {"--write-run"},
                     fmt::format("no run {}; expected 0 to {}", *line.write_run, sweep.runs() - 1));
  const auto file =
      std::filesystem::path(line.how.out) / fmt::format("{}.run-{}.yaml", sweep.name(), *line.write_run);
  write_run(file, sweep.setup(), *line.write_run);
  if (line.json)
    print_json(
        {{"run", *line.write_run}, {"file", file.string()}, {"command", sweep.command(*line.write_run)}});
  else
    fmt::print("{}\n", as_called(fmt::format("run {} is written: mixloop simulate {}", *line.write_run,
                                             printable_name(file.string()))));
  return kHeld;
}

int run(SweepLine& line) {
  StopSwitch stop;
  stop.turn_on_signals();
  const ShownWork work(stop);
  line.how.peers = peers_here();
  if (line.how.threads == 0)
    line.how.threads =
        line.how.peers != nullptr ? 1 : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  line.how.part = part_of(line.shard);
  if (!line.how.part.is_whole() && line.how.out.empty())
    throw InputError("missing_key", {"--shard"},
                     "a shard is kept for --merge; expected --out FOLDER, the same for all");
  if (line.how.merges && line.how.out.empty())
    throw InputError("missing_key", {"--merge"},
                     "nothing to merge; expected --out FOLDER, that of the shards");
  const Sweep sweep(name_of_sweep(line.file), request_of(line), line.evaluation, line.hashes);
  if (line.write_run) return write_one(line, sweep);
  if (line.how.peers != nullptr && line.how.peers->rank() > 0) {
    const auto patience = std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * line.how.patience));
    line.how.peers->leave(follow(
        *line.how.peers, sweep, LaneEngine(), line.how.threads, [&] { return !stop.turned(); }, patience));
    return kHeld;
  }
  line.how.quiet = line.json;
  const Swept result = swept(sweep, line.how, stop);
  if (line.json)
    print_json(json_of(sweep, result, line.how));
  else
    fmt::print("{}", summary(sweep, result, line.how));
  return result.exit_status;
}

}  // namespace

void add_sweep_command(CLI::App& app, int& status) {
  auto options = std::make_shared<SweepLine>();
  auto* command = app.add_subcommand(
      "sweep", "many runs of an experiment, its entries varied; a table and statistics of them");
  command->add_option("experiment", options->file, "an experiment's file, or a sweep's (*.sweep.yaml)")
      ->required()
      ->type_name("EXPERIMENT");
  const auto add_list = [&](const char* name, std::vector<std::string>& list, const char* what,
                            const char* type) {
    command->add_option(name, list, what)
        ->type_name(type)
        ->take_all()
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  };
  add_list(
      "--vary", options->vary,
      "go through values of an entry: FROM..TO:COUNT evenly (0..5 kg:11), or listed (0,2,5 kg); of several "
      "entries all combinations; keys as of --set, a scene's own by scene.KEY",
      "KEY=VALUES");
  add_list("--sample", options->sample, "draw an entry: normal(MEAN, STD) or uniform(FROM, TO), with units",
           "KEY=DISTRIBUTION");
  command
      ->add_option("--runs", options->runs,
                   "how many are drawn (at each combination of what is varied), 1000")
      ->type_name("N")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 40));
  command
      ->add_option("--design", options->design,
                   "how what is drawn is spread: latin (default), sobol or random; grid: all is varied")
      ->check(CLI::IsMember(spread_names()).description(""))
      ->type_name("DESIGN");
  command->add_option("--seed", options->seed, "of what is drawn, 1")->type_name("S");
  command
      ->add_option(
          "--out", options->how.out,
          "keep table.csv, table.h5 and summary.json in this folder; interrupted or killed, the same "
          "command goes on there")
      ->type_name("DIR");
  command
      ->add_option("--threads", options->how.threads,
                   "how many runs at a time; one a core, by mpirun one a rank")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command
      ->add_option("--shard", options->shard,
                   "do the I-th of N parts alone, of a job array; --merge puts them together")
      ->type_name("I/N");
  command->add_flag("--merge", options->how.merges, "make the table of what shards have done");
  add_seconds_option(*command, "--patience", options->how.patience,
                     "seconds of silence after which a rank of mpirun is lost, and others do its runs, 10");
  command
      ->add_option("--settled-within", options->settled_within,
                   "tell when the position error has come below this for good, e.g. '2 mm'")
      ->type_name("LENGTH");
  command->add_flag("--hashes", options->hashes, "tell each trajectory's SHA-256, which takes its time");
  command
      ->add_option("--write-run", options->write_run,
                   "write the experiment of run K alone, into the current folder or --out, and run nothing")
      ->type_name("K");
  add_common_options(*command, *options);
  add_case_option(*command, options->case_name);
  add_evaluation_option(*command, options->evaluation);
  command->footer(
      "A sweep's file has the same, and what its runs are to hold (docs/sweeps.md); mixloop track holds it, "
      "too.\n"
      "Runs count from 0 and each is, to the bit, what mixloop simulate makes of that experiment. Exit "
      "status: 1 "
      "where the\n"
      "sweep's own `expect` is missed; runs that diverge are told.\n"
      "Examples:\n"
      "  mixloop sweep experiments/paper.yaml --vary parameters.payload='0..5 kg:11' --vary "
      "controller.kp[0]=80,100\n"
      "  mixloop sweep experiments/paper.yaml --sample parameters.payload='normal(5 kg, 0.5 kg)' --runs "
      "10000 "
      "--out results/payload\n"
      "  mixloop sweep experiments/payload.sweep.yaml --out results/payload --shard 3/8\n"
      "  mpirun -n 8 --enable-recovery mixloop sweep experiments/payload.sweep.yaml --out results/payload");
  options->how.threads = 0;
  command->callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
