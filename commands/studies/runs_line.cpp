// SPDX-License-Identifier: MIT
#include "commands/studies/runs_line.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <thread>

#include "notation/value.hpp"

namespace mixloop {

SweepRequest request_of(RunsLine& line) {
  SweepRequest request;
  if (is_sweep(line.file)) {
    request = read_sweep(line.file);
  } else {
    line.take_case(line.file, line.case_name);
    request.experiment = line.file;
  }
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

int threads_of(const RunsLine& line) {
  return line.threads > 0 ? line.threads
                          : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

void add_list_option(CLI::App& command, const char* name, std::vector<std::string>& list, const char* what,
                     const char* type) {
  command.add_option(name, list, what)
      ->type_name(type)
      ->take_all()
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_runs_options(CLI::App& command, RunsLine& line, std::int64_t draws) {
  add_list_option(
      command, "--vary", line.vary,
      "go through values of an entry: FROM..TO:COUNT evenly (0..5 kg:11), or listed (0,2,5 kg); of several "
      "entries all combinations; keys as of --set, a scene's own by scene.KEY",
      "KEY=VALUES");
  add_list_option(command, "--sample", line.sample,
                  "draw an entry: normal(MEAN, STD) or uniform(FROM, TO), with units", "KEY=DISTRIBUTION");
  command
      .add_option("--runs", line.runs,
                  fmt::format("how many are drawn (at each combination of what is varied), {}", draws))
      ->type_name("N")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 40));
  command
      .add_option("--design", line.design,
                  "how what is drawn is spread: latin (default), sobol or random; grid: all is varied")
      ->check(CLI::IsMember(spread_names()).description(""))
      ->type_name("DESIGN");
  command.add_option("--seed", line.seed, "of what is drawn, 1")->type_name("S");
  command.add_option("--threads", line.threads, "how many runs at a time; one a core")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command
      .add_option("--settled-within", line.settled_within,
                  "tell when the position error has come below this for good, e.g. '2 mm'")
      ->type_name("LENGTH");
  add_common_options(command, line);
  add_case_option(command, line.case_name);
  add_evaluation_option(command, line.evaluation);
}

}  // namespace mixloop
