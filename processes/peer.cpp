// SPDX-License-Identifier: MIT
#include "processes/peer.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "loop/measured.hpp"
#include "loop/result.hpp"
#include "processes/config_words.hpp"

namespace mixloop {

PeerOptions peer_options(const PeerLine& line, const Experiment& experiment, std::int64_t last_tick,
                         const char* program) {
  return {.n = static_cast<int>(measured_coordinates(experiment).size()),
          .n_u = experiment.scene->n_u(),
          .session = line.session,
          .config = config_of(common_ground(experiment)),
          .config_words = config_words(experiment),
          .rate_hz = experiment.rate_hz,
          .references = experiment.has_path(),
          .last_tick = last_tick,
          .first_wait = line.first_wait_ns(),
          .patience = line.patience_ns(),
          .max_missed = experiment.deadline.max_missed,
          .notice = [program](const std::string& text) { fmt::print(stderr, "{}: {}\n", program, text); }};
}

int ended(const char* program, Ending ending, const PeerReport& report, const StopSwitch& stop) {
  if (report.joined_late) fmt::print(stderr, "{}: joined late, at a tick past 0\n", program);
  if (ending != Ending::finished)
    fmt::print(stderr, "{}: {} after {} ticks ({} answered again)\n", program, name(ending), report.answered,
               report.repeated);
  // Stale ones alone are a lossy network's, and worth no word.
  if (report.rejects.total() > report.rejects.of(Reject::stale))
    fmt::print(stderr, "{}: {} messages dropped: {}\n", program, report.rejects.total(),
               to_string(report.rejects));
  if (ending == Ending::broken_off) return kHeld;  // the plant's fault, which it reports
  return stop.turned() ? kInterrupted : kHeld;
}

int peer_main(int argc, char** argv, const char* description, const char* footer,
              int (*run)(const PeerLine&)) {
  int status = 0;
  PeerLine line;
  CLI::App app(description);
  add_peer_options(app, line);
  app.footer(std::string(footer) +
             "\nLeaves when the plant says END, after --patience without a STATE, or on Ctrl-C.");
  app.callback([&] { status = run(line); });
  return run_command_line(argc, argv, app, status);
}

}  // namespace mixloop
