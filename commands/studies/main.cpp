// SPDX-License-Identifier: MIT
#include "commands/commands.hpp"
#include "commands/shared/executables.hpp"

int main(int argc, char** argv) {
  using namespace mixloop;
  return run_commands(Executable::studies,
                      {
                          {"track", add_track_command},
                          {"sweep", add_sweep_command},
                          {"tune", add_tune_command},
                          {"stability", add_stability_command},
                      },
                      argc, argv);
}
