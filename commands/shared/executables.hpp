// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

namespace CLI {
class App;
}

namespace mixloop {

/// The executables that the commands of `mixloop` are built into, a folder of commands/ each: whoever runs an
/// experiment needn't build what studies it. A person calls `runs` by the name of mixloop; it hands a line
/// over to the one that has its command.
enum class Executable { runs, scenes, studies, records };

/// Gives a command, which has its name and a line of help, its options and what it does. `status` receives
/// the exit status.
using AddCommand = void (*)(CLI::App& command, int& status);

/// The main function of one that has `commands`: obeys the line, or hands it over.
int run_commands(Executable own, const std::map<std::string, AddCommand>& commands, int argc, char** argv);

}  // namespace mixloop
