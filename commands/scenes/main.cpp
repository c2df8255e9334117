// SPDX-License-Identifier: MIT
#include "commands/commands.hpp"
#include "commands/shared/executables.hpp"

int main(int argc, char** argv) {
  using namespace mixloop;
  return run_commands(Executable::scenes,
                      {
                          {"import", add_import_command},
                          {"assemble", add_assemble_command},
                          {"dynamics", add_dynamics_command},
                          {"explain", add_explain_command},
                          {"compile", add_compile_command},
                          {"schema", add_schema_command},
                      },
                      argc, argv);
}
