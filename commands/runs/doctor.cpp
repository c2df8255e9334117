// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <functional>

#include "commands/commands.hpp"
#include "commands/shared/progress.hpp"
#include "loop/result.hpp"
#include "notation/long_work.hpp"
#include "processes/bus_line.hpp"
#include "processes/called_as.hpp"
#include "processes/standard_output.hpp"
#include "runtime/machine/fitness.hpp"

namespace mixloop {
namespace {

struct DoctorLine {
  BusOptions bus;
  bool json = false;
  double seconds = 2;
};

const char* name_of(Fitness verdict) {
  return verdict == Fitness::good ? "good" : verdict == Fitness::fair ? "fair" : "BAD";
}

int run(const DoctorLine& options) {
  StopSwitch stop;
  stop.turn_on_signals();
  const ShownWork work(stop);
  const nanoseconds span(static_cast<std::int64_t>(options.seconds * 1e9));
  const std::vector<std::function<Finding()>> checks = {
      [&] { return multicast_finding(options.bus); },
      receive_buffer_finding,
      priority_finding,
      locked_memory_finding,
      governor_finding,
      idle_latency_finding,
      [&] { return wake_up_finding(span); },
      [&] { return round_trip_finding(options.bus, span); },
      [&] { return publishers_finding(options.bus, std::min<nanoseconds>(span, std::chrono::seconds(1))); },
  };
  bool fit = true, interrupted = false;
  auto findings = nlohmann::json::array();
  for (const auto& check : checks) {
    Finding finding;
    try {
      finding = check();
      finding.mend = as_called(finding.mend);
    } catch (const Interrupted&) {
      interrupted = true;
      break;
    }
    fit = fit && finding.verdict != Fitness::bad;
    findings.push_back({{"what", finding.what},
                        {"value", finding.value},
                        {"verdict", finding.verdict == Fitness::bad ? "bad" : name_of(finding.verdict)},
                        {"mend", finding.mend}});
    if (options.json) continue;
    fmt::print("{:<5} {:<25} {}\n", name_of(finding.verdict), finding.what, finding.value);
    if (!finding.mend.empty()) fmt::print("      {:<25} {}\n", "", finding.mend);
    flush_standard_output();
  }
  if (options.json)
    print_json({{"fit", fit && !interrupted}, {"findings", findings}});
  else if (interrupted)
    fmt::print(stderr, "mixloop: interrupted; the rest was not looked at\n");
  else
    fmt::print("{}\n", fit ? "1 kHz will hold here." : "1 kHz will NOT hold here: see what is BAD.");
  return interrupted ? kInterrupted : fit ? kHeld : kMissed;
}

}  // namespace

void add_doctor_command(CLI::App& command, int& status) {
  auto options = std::make_shared<DoctorLine>();
  add_bus_options(command, options->bus);
  command.add_option("--seconds", options->seconds, "to measure wake-ups and round trips for, 2 each")
      ->check(CLI::Range(0.1, 3600.0))
      ->type_name("S");
  command.add_flag("--json", options->json, "print one JSON object on stdout and nothing else");
  command.footer(
      "good: as it should be. fair: 1 kHz holds with less margin than there could be. BAD: it won't hold, "
      "exit "
      "status 1.\n"
      "Measure on the machine as it will be used: other work shows.");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
