// SPDX-License-Identifier: MIT

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <charconv>

#include "commands/commands.hpp"
#include "commands/shared/progress.hpp"
#include "commands/studies/modules.hpp"
#include "commands/studies/runs_line.hpp"
#include "commands/studies/swept.hpp"
#include "notation/utf8.hpp"
#include "notation/words.hpp"
#include "processes/called_as.hpp"
#include "processes/command_line.hpp"
#include "sweep/kernel/closed_loops.hpp"
#include "sweep/leading.hpp"
#include "sweep/sweep.hpp"
#include "sweep/written_run.hpp"

namespace mixloop {
namespace {

struct SweepLine : RunsLine {
  std::optional<std::int64_t> write_run;
  std::string shard;
  bool hashes = false;
  SweepOptions how;
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
  line.how.threads = line.how.peers != nullptr && line.threads == 0 ? 1 : threads_of(line);
  line.how.part = part_of(line.shard);
  if (!line.how.part.is_whole() && line.how.out.empty())
    throw InputError("missing_key", {"--shard"},
                     "a shard is kept for --merge; expected --out FOLDER, the same for all");
  if (line.how.merges && line.how.out.empty())
    throw InputError("missing_key", {"--merge"},
                     "nothing to merge; expected --out FOLDER, that of the shards");
  const std::string as_asked = called(line);
  SweepRequest request = request_of(line);
  request.called = as_asked;
  const Sweep sweep(name_of_sweep(line.file), request, line.evaluation, line.hashes);
  if (line.write_run) return write_one(line, sweep);
  if (line.how.peers != nullptr && line.how.peers->rank() > 0) {
    const auto patience = std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * line.how.patience));
    line.how.peers->leave(follow(
        *line.how.peers, sweep, LaneEngine(line.how.device), line.how.threads, [&] { return !stop.turned(); },
        patience));
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

void add_sweep_command(CLI::App& command, int& status) {
  auto options = std::make_shared<SweepLine>();
  command.add_option("experiment", options->file, "an experiment's file, or a sweep's (*.sweep.yaml)")
      ->required()
      ->type_name("EXPERIMENT");
  add_runs_options(command, *options, 1000);
  command
      .add_option("--out", options->how.out,
                  "keep table.csv, table.h5 and summary.json in this folder; interrupted or killed, the same "
                  "command goes on there")
      ->type_name("DIR");
  command
      .add_option_function<std::string>(
          "--device",
          [options](const std::string& device) {
            options->how.device = device == "cuda" ? LoopDevice::cuda : LoopDevice::cpu;
          },
          "where runs go side by side: cpu, or cuda, a graphics processor, which takes nvcc; the bytes are "
          "the same")
      ->check(CLI::IsMember({"cpu", "cuda"}).description(""))
      ->type_name("DEVICE");
  command
      .add_option("--shard", options->shard,
                  "do the I-th of N parts alone, of a job array; --merge puts them together")
      ->type_name("I/N");
  command.add_flag("--merge", options->how.merges, "make the table of what shards have done");
  add_seconds_option(command, "--patience", options->how.patience,
                     "seconds of silence after which a rank of mpirun is lost, and others do its runs, 10");
  command.add_flag("--hashes", options->hashes, "tell each trajectory's SHA-256, which takes its time");
  command
      .add_option("--write-run", options->write_run,
                  "write the experiment of run K alone, into the current folder or --out, and run nothing")
      ->type_name("K");
  command.footer(
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
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
