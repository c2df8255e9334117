// SPDX-License-Identifier: MIT
#include "commands/commands.hpp"
#include "commands/shared/executables.hpp"

int main(int argc, char** argv) {
  using namespace mixloop;
  return run_commands(Executable::runs,
                      {
                          {"simulate", add_simulate_command},
                          {"run", add_run_command},
                          {"replay", add_replay_command},
                          {"control", add_control_command},
                          {"spy", add_spy_command},
                          {"monitor", add_monitor_command},
                          {"doctor", add_doctor_command},
                          {"netns", add_netns_command},
                      },
                      argc, argv);
}
