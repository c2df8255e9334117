// SPDX-License-Identifier: MIT
#include "commands/shared/executables.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>

#include "notation/errors.hpp"
#include "processes/called_as.hpp"
#include "processes/command_line.hpp"

namespace mixloop {
namespace {

struct Command {
  const char* name;
  Executable executable;
  const char* help;
};

/// All of them, as `mixloop --help` lists them.
constexpr Command kCommands[] = {
    {"simulate", Executable::runs, "the closed loop in one process, as fast as it goes"},
    {"run", Executable::runs, "the three processes over LCM: launches them, waits, summarises"},
    {"replay", Executable::runs, "a log's states and references through the controller again"},
    {"control", Executable::runs, "steers a plant that is running: pause, step, speed, reset, stop"},
    {"track", Executable::studies, "tracking-error tests: runs experiments and holds what each expects"},
    {"sweep", Executable::studies,
     "many runs of an experiment, its entries varied; a table and statistics of them"},
    {"tune", Executable::studies,
     "numbers of an experiment, gains for instance, made the best ones within bounds"},
    {"import", Executable::scenes, "a robot's URDF as a scene and an experiment"},
    {"assemble", Executable::scenes,
     "how a scene's closures hold at home: the pose, and other ways to put it together"},
    {"dynamics", Executable::scenes, "one evaluation of a scene's equations of motion, M psi'' + h = tau"},
    {"explain", Executable::scenes, "what a scene's programs skip, why, and what that saves"},
    {"compile", Executable::scenes,
     "a scene's programs as machine code (kept in the cache), or as C++ source"},
    {"stability", Executable::studies, "where the sampled loop is stable, and its margins"},
    {"report", Executable::records, "one self-contained HTML page of results or logs"},
    {"view", Executable::records, "the mechanism in a browser, live from the bus or from a log"},
    {"spy", Executable::runs, "lcm-spy with our message types"},
    {"monitor", Executable::runs, "what happens on the bus, in a terminal"},
    {"doctor", Executable::runs, "is this machine fit for 1 kHz; each 'no' with what mends it"},
    {"export", Executable::records, "a log's messages as CSV, one file a channel"},
    {"netns", Executable::runs,
     "runs a command in a network namespace of its own that has LCM's multicast route"},
    {"schema", Executable::scenes,
     "JSON Schema of a scene, an experiment or a sweep, for editors and checks"},
};

std::string file_of(Executable executable) {
  switch (executable) {
    case Executable::runs:
      return own_folder() + "/mixloop";
    case Executable::scenes:
      return part("mixloop-scenes");
    case Executable::studies:
      return part("mixloop-studies");
    case Executable::records:
      return part("mixloop-records");
  }
  return {};
}

/// This process goes on as `command`'s executable, with the same line.
[[noreturn]] void hand_over(const Command& command, char** argv) {
  const std::string file = file_of(command.executable);
  execv(file.c_str(), argv);
  const bool is_absent = errno == ENOENT;
  throw RunFault("missing_part",
                 std::string("mixloop ") + command.name +
                     (is_absent ? " isn't built here (no " + file + "); tools/build builds all commands"
                                : " can't be started (" + file + "): " + std::strerror(errno)));
}

}  // namespace

int run_commands(Executable own, const std::map<std::string, AddCommand>& commands, int argc, char** argv) {
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
  for (const Command& known : kCommands) {
    auto* command = app.add_subcommand(known.name, known.help);
    if (known.executable == own) {
      commands.at(known.name)(*command, status);
      continue;
    }
    command->set_help_flag();  // the one that has the command has its help
    command->prefix_command();
    command->callback([&known, argv] { hand_over(known, argv); });
  }
  return run_command_line(argc, argv, app, status);
}

}  // namespace mixloop
