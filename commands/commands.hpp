// SPDX-License-Identifier: MIT
#pragma once

namespace CLI {
class App;
}

/// The commands of `mixloop`, each in the file of its name: AddCommand (commands/shared/executables.hpp).
namespace mixloop {

void add_simulate_command(CLI::App& command, int& status);
void add_run_command(CLI::App& command, int& status);
void add_control_command(CLI::App& command, int& status);
void add_replay_command(CLI::App& command, int& status);
void add_sweep_command(CLI::App& command, int& status);
void add_tune_command(CLI::App& command, int& status);
void add_track_command(CLI::App& command, int& status);
void add_dynamics_command(CLI::App& command, int& status);
void add_import_command(CLI::App& command, int& status);
void add_assemble_command(CLI::App& command, int& status);
void add_explain_command(CLI::App& command, int& status);
void add_compile_command(CLI::App& command, int& status);
void add_stability_command(CLI::App& command, int& status);
void add_report_command(CLI::App& command, int& status);
void add_view_command(CLI::App& command, int& status);
void add_spy_command(CLI::App& command, int& status);
void add_doctor_command(CLI::App& command, int& status);
void add_export_command(CLI::App& command, int& status);
void add_netns_command(CLI::App& command, int& status);
void add_schema_command(CLI::App& command, int& status);
void add_monitor_command(CLI::App& command, int& status);

}  // namespace mixloop
