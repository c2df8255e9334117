// SPDX-License-Identifier: MIT
#include "commands/commands.hpp"
#include "commands/shared/executables.hpp"

int main(int argc, char** argv) {
  using namespace mixloop;
  return run_commands(Executable::records,
                      {
                          {"report", add_report_command},
                          {"view", add_view_command},
                          {"export", add_export_command},
                      },
                      argc, argv);
}
