// SPDX-License-Identifier: MIT
#include <CLI/CLI.hpp>

#include "commands/commands.hpp"
#include "processes/command_line.hpp"

int main(int argc, char** argv) {
  int status = 0;
  CLI::App app(
      "mixloop: equations of motion of geared, loop-constrained mechanisms, run as a plant and a controller "
      "over LCM.");
  app.set_version_flag("--version", MIXLOOP_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 held, 1 a bound missed, 2 bad input, 3 a fault at run time (divergence, a lost peer), "
      "130 interrupted.\n"
      "Each command has its own --help, e.g. mixloop simulate --help.");
  mixloop::add_simulate_command(app, status);
  mixloop::add_run_command(app, status);
  mixloop::add_replay_command(app, status);
  mixloop::add_control_command(app, status);
  mixloop::add_track_command(app, status);
  mixloop::add_sweep_command(app, status);
  mixloop::add_tune_command(app, status);
  mixloop::add_import_command(app, status);
  mixloop::add_assemble_command(app, status);
  mixloop::add_dynamics_command(app, status);
  mixloop::add_explain_command(app, status);
  mixloop::add_compile_command(app, status);
  mixloop::add_stability_command(app, status);
  mixloop::add_report_command(app, status);
  mixloop::add_view_command(app, status);
  mixloop::add_spy_command(app, status);
  mixloop::add_monitor_command(app, status);
  mixloop::add_doctor_command(app, status);
  mixloop::add_export_command(app, status);
  mixloop::add_netns_command(app, status);
  mixloop::add_schema_command(app, status);
  return mixloop::run_command_line(argc, argv, app, status);
}
