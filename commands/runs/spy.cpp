// SPDX-License-Identifier: MIT
// lcm-spy with our types. Debian's own launcher passes an option that Java 17 refuses, and has no types of
// ours.
#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "commands/commands.hpp"
#include "processes/bus_line.hpp"
#include "processes/called_as.hpp"
#include "runtime/bus/multicast_route.hpp"

namespace mixloop {
namespace {

constexpr const char* kPackages = "apt-get install openjdk-17-jre liblcm-java libjchart2d-java";

std::string required(const std::string& file, const std::string& what, const std::string& mend) {
  std::error_code failed;
  if (!std::filesystem::exists(file, failed))
    throw RunFault("missing_part", fmt::format("{} is missing ({}); {}", what, file, mend));
  return file;
}

int run(const BusOptions& bus) {
  // lcm-spy finds types in what CLASSPATH names, and needs them on its own class path too.
  std::string types = required(shared_file("types.jar"), "the jar of the message types",
                               std::string("it is built where there is a JDK: ") + kPackages +
                                   " openjdk-17-jdk-headless, then build again");
  if (const char* others = std::getenv("CLASSPATH"); others && *others) types += std::string(":") + others;
  const std::string classes = required("/usr/share/java/lcm.jar", "LCM's jar", kPackages) + ":" +
                              required("/usr/share/java/jchart2d.jar", "lcm-spy's plots", kPackages) + ":" +
                              types;
  if (!std::getenv("DISPLAY"))
    throw RunFault("no_display",
                   "lcm-spy opens a window and DISPLAY is not set; mixloop monitor works without");
  require_multicast_route(multicast_group(bus.url));
  setenv("CLASSPATH", types.c_str(), 1);
  setenv("LCM_DEFAULT_URL", bus.url.c_str(), 1);
  execlp("java", "java", "-Djava.net.preferIPv4Stack=true", "-Xmx256m", "-cp", classes.c_str(), "lcm.spy.Spy",
         static_cast<char*>(nullptr));
  throw RunFault("cannot_start",
                 fmt::format("java can't be started: {}; {}", std::strerror(errno), kPackages));
}

}  // namespace

void add_spy_command(CLI::App& command, int& status) {
  auto bus = std::make_shared<BusOptions>();
  if (const char* url = std::getenv("LCM_DEFAULT_URL"); url && *url) bus->url = url;
  command.add_option("--lcm-url", bus->url, "where the bus is; LCM_DEFAULT_URL, else " + bus->url)
      ->type_name("URL");
  command.footer(
      "Double-click a channel to see its fields, and a field to plot it. Types of your own are found in "
      "what\n"
      "CLASSPATH names. In the network namespace of a run that holds:\n"
      "  nsenter --preserve-credentials --user --net --target PID mixloop spy");
  command.callback([bus, &status] { status = run(*bus); });
}

}  // namespace mixloop
