// SPDX-License-Identifier: MIT
#include "tuning/tune.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <atomic>

#include "commands/commands.hpp"
#include "commands/shared/progress.hpp"
#include "commands/shared/warnings.hpp"
#include "commands/studies/runs_line.hpp"
#include "commands/studies/sweep_progress.hpp"
#include "commands/studies/tuned.hpp"
#include "loop/output_file.hpp"
#include "notation/long_work.hpp"
#include "notation/utf8.hpp"
#include "stability/gnuplot.hpp"
#include "sweep/written_run.hpp"
#include "tuning/minimise.hpp"
#include "tuning/picture.hpp"

namespace mixloop {
namespace {

constexpr std::int64_t kDraws = 64;  // of each candidate, unless the line says how many

struct TuneLine : RunsLine {
  std::vector<std::string> over, subject;
  std::string minimise, maximise, out, picture;
  double share = 1;
  int poses = 21;
  std::int64_t evaluations = 500;
};

TuneRequest tune_request_of(TuneLine& line) {
  if (!line.minimise.empty() && !line.maximise.empty())
    throw InputError("doubly_defined", {"--maximise"},
                     "something is minimised already; expected one of --minimise and --maximise");
  TuneRequest request{.sweep = request_of(line),
                      .over = line.over,
                      .subject = line.subject,
                      .goal = line.minimise.empty() ? line.maximise : line.minimise,
                      .maximises = line.minimise.empty() && !line.maximise.empty(),
                      .share = line.share,
                      .poses = line.poses,
                      .evaluation = line.evaluation};
  if (!request.sweep.draws_given) request.sweep.design.draws = kDraws;
  return request;
}

/// Where the tuned experiment goes: its file, or a folder for it. Looked at before anything takes long.
std::filesystem::path file_for(const TuneLine& line, const std::filesystem::path& experiment) {
  const std::string name = printable_name(experiment.stem().string()) + ".tuned.yaml";
  std::filesystem::path file = line.out.empty() ? name : line.out;
  std::error_code none;
  if (!line.out.empty() && (line.out.ends_with('/') || std::filesystem::is_directory(file, none)))
    file /= name;
  if (std::filesystem::equivalent(file, experiment, none))
    throw InputError(
        "file_exists", {"--out"},
        in_quotes(file.string()) + " is the experiment that is tuned; expected another file, or a folder");
  if (!line.picture.empty()) terminal_for(line.picture, 1, 1);
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), none);
  const OutputFile there(file);  // that it can be written is known before anything takes long
  if (!line.picture.empty()) const OutputFile drawn(line.picture);
  return file;
}

Tuned searched(const Problem& problem, const TuneLine& line) {
  ShownSweep shown(problem.setup().experiment().name, line.json, "evaluations");
  const auto& unit = problem.criteria()[problem.goal().criteria[0]].unit;
  return tune(problem, line.evaluations, [&](const TuneProgress& progress) {
    shown.at({.done = progress.done, .of = progress.of, .rate = progress.rate},
             progress.best->is_feasible()
                 ? fmt::format("; best {:.6g}{}", progress.best->goal, unit == "1" ? "" : " " + unit)
                 : "; nothing yet that holds all bounds");
  });
}

/// What simulate will warn of.
std::vector<std::string> warnings_of_tuned(const Problem& problem, const std::vector<double>& values) try {
  const PreparedRun run = problem.setup().prepared(0, problem.overrides(values));
  return warnings_of(run.experiment, *run.plan, true);
} catch (const InputError&) {  // it can't be run at all, which is told
  return {};
}

int run(TuneLine& line) {
  if (!can_minimise())
    throw RunFault(
        "missing_part",
        "this mixloop was built without NLopt, which searches; expected a build with libnlopt-dev");
  StopSwitch stop;
  stop.turn_on_signals();
  const ShownWork work(stop);
  const TuneRequest request = tune_request_of(line);
  const std::filesystem::path file = file_for(line, request.sweep.experiment);
  std::atomic<bool> is_over = false;  // what there is is told after an interruption, too
  const Problem problem(request, threads_of(line), [&] { return is_over || !stop.turned(); });

  TuneStory story{.problem = &problem, .tuned = searched(problem, line), .before = {}, .after = {}};
  is_over = true;
  const Uninterrupted whole;
  story.before = problem.alone(problem.before().values);
  story.after = problem.alone(story.tuned.best.values);
  story.warnings = warnings_of_tuned(problem, story.tuned.best.values);
  if (story.tuned.best.is_feasible()) {
    write_experiment(file, head_of(story), problem.setup(), problem.overrides(story.tuned.best.values));
    story.file = file.string();
    if (!line.picture.empty() && !story.tuned.interrupted) {
      draw_tuned(problem, problem.before().values, story.tuned.best.values, line.picture);
      story.picture = line.picture;
    }
  }
  if (line.json)
    print_json(json_of(story));
  else
    fmt::print("{}", summary(story));
  return story.exit_status();
}

}  // namespace

void add_tune_command(CLI::App& command, int& status) {
  auto options = std::make_shared<TuneLine>();
  command.add_option("experiment", options->file, "an experiment's file, or a sweep's (*.sweep.yaml)")
      ->required()
      ->type_name("EXPERIMENT");
  add_list_option(command, "--over", options->over,
                  "what is tuned: numbers or lists of numbers, parted by commas, each from a tenth to ten "
                  "times what stands unless it says KEY=FROM..TO",
                  "KEY,...");
  command
      .add_option("--minimise", options->minimise,
                  "what is to come least: of what a run measures (max_position_error) or stability tells "
                  "(spectral_radius)")
      ->type_name("NAME");
  command.add_option("--maximise", options->maximise, "what is to come most in its place (longest_delay)")
      ->type_name("NAME");
  add_list_option(
      command, "--subject", options->subject,
      "what must hold: NAME and <, <=, > or >= and a number with its unit, or 'now' or '0.9 now': "
      "so many times what it is before",
      "'NAME < BOUND'");
  command
      .add_option("--share", options->share,
                  "of the runs that count: 0.95 leaves out the worst 5 %, for each name by itself (1)")
      ->check(CLI::Range(1e-9, 1.0))
      ->type_name("SHARE");
  command.add_option("--evaluations", options->evaluations, "candidates that are looked at, at most (500)")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{10'000'000}))
      ->type_name("N");
  command
      .add_option("--poses", options->poses, "at how many instants of the path stability is looked at (21)")
      ->check(CLI::Range(2, 10'000))
      ->type_name("N");
  command
      .add_option("--out", options->out,
                  "the tuned experiment's file, or a folder for it (NAME.tuned.yaml in the current one)")
      ->type_name("FILE");
  command
      .add_option("--picture", options->picture,
                  "draw errors, torques and stability, before and after, in this .svg or .png")
      ->type_name("FILE");
  add_runs_options(command, *options, kDraws);
  command.footer(
      "Of what is drawn (--sample) or varied (--vary), as mixloop sweep has it, the worst run counts.\n"
      "Margins are those of mixloop stability, by its names: spectral_radius, longest_delay, longest_tick "
      "(along the path),\n"
      "longest_tick_without_delay, longest_rk4_step, fastest_pole, gain_margin.most, gain_margin.least, "
      "gain_margin_of_motor.\n"
      "The same command comes to the same bytes. Ctrl-C tells and writes the best so far. Exit status: 1 "
      "where nothing\n"
      "holds all bounds, or the tuned experiment misses what it expects.\n"
      "Examples:\n"
      "  mixloop tune experiments/paper.yaml --over controller.kp,controller.kv --minimise "
      "max_position_error \\\n"
      "    --subject 'max_torque <= now' --subject 'longest_delay >= now' --picture tuned.svg\n"
      "  mixloop tune experiments/paper.yaml --over controller.kp=10..1000,controller.kv --minimise "
      "rms_position_error \\\n"
      "    --subject 'max_torque < 5 N m' --subject 'longest_delay > 0.3 ms' \\\n"
      "    --sample plant.parameters.payload='normal(5 kg, 0.5 kg)' --sample "
      "plant.command_delay='uniform(0, 200 us)'");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
