// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <sys/resource.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "commands/records/log_options.hpp"
#include "commands/records/web_page.hpp"
#include "commands/shared/progress.hpp"
#include "processes/bus_line.hpp"
#include "processes/standard_output.hpp"
#include "view/bus_source.hpp"
#include "view/log_source.hpp"
#include "view/server.hpp"

namespace mixloop {
namespace {

struct ViewLine : LogOptions {
  std::string what;
  BusOptions bus;
  ServerOptions server;
};

constexpr int kNice = 10;

/// An experiment is a YAML file; all else is a log or a kept result.
bool is_experiment(const std::filesystem::path& path) {
  return path.extension() == ".yaml" || path.extension() == ".yml";
}

std::unique_ptr<Source> source_of(ViewLine& options) {
  if (is_experiment(options.what)) {
    if (!options.experiment.empty())
      throw InputError("command_line", {"--experiment"},
                       "is for a log; the experiment of a live run is named already");
    const Experiment experiment = load_experiment(std::filesystem::path(options.what), options.overrides());
    if (experiment.plant.partitions) refuse_switched({options.what});
    return std::make_unique<BusSource>(options.bus, experiment, config_of(common_ground(experiment)));
  }
  options.read.prefix = options.bus.prefix;
  options.take_experiment();
  return std::make_unique<LogSource>(options.what, options.read);
}

int run(ViewLine& options) {
  StopSwitch stop;
  stop.turn_on_signals();
  const ShownWork work(stop);
  const std::string page = web_page("view.html");
  // Pages, however many and however much they ask for, take what a plant on this machine leaves.
  if (is_experiment(options.what)) setpriority(PRIO_PROCESS, 0, kNice);
  const auto source = source_of(options);
  Server server(options.server, page);
  const std::string url = fmt::format("http://127.0.0.1:{}/", server.port());
  if (options.json)
    print_json({{"url", url}, {"mode", is_experiment(options.what) ? "live" : "log"}});
  else
    fmt::print("{}: open it in a browser on this machine; Ctrl-C ends it\n", url);
  flush_standard_output();
  server.run(*source, stop);
  return 0;
}

}  // namespace

void add_view_command(CLI::App& command, int& status) {
  auto options = std::make_shared<ViewLine>();
  command
      .add_option("what", options->what,
                  "the experiment that runs (.yaml), or a log or a folder that --out kept")
      ->required()
      ->type_name("EXPERIMENT|LOG|RESULT_DIR");
  command.add_option("--port", options->server.port, "on 127.0.0.1; 0 takes one that is free")
      ->type_name("PORT");
  command.add_option("--fps", options->server.frames_per_second, "poses a second to a browser at most, 60")
      ->check(CLI::Range(1.0, 240.0))
      ->type_name("N");
  add_log_options(command, *options);
  add_bus_options(command, options->bus);
  add_common_options(command, *options);
  command.footer(
      "The page is served to this machine only, and can command nothing. It may stay open while the plant is "
      "started\n"
      "again. Live, it listens on the bus that the run is on: start it in the same network namespace.\n"
      "Examples:\n"
      "  mixloop view experiments/paper.yaml                 # then: mixloop run experiments/paper.yaml "
      "--speed 1\n"
      "  mixloop view results/paper --port 0                 # a run that is over: pause, scrub\n"
      "  mixloop view lcm-log.00 --experiment experiments/paper.yaml");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
