// SPDX-License-Identifier: MIT
#pragma once

#include "processes/command_line.hpp"
#include "runtime/bus/bus.hpp"
#include "runtime/machine/real_time_rights.hpp"
#include "runtime/protocol/config_hash.hpp"

namespace mixloop {

/// `--lcm-url`, `--channel-prefix`; the default url is LCM_DEFAULT_URL's, else LCM's own with ttl=0.
void add_bus_options(CLI::App& command, BusOptions& options);

/// What the three processes take beside the experiment.
struct PeerLine : CommonOptions {
  std::string experiment;
  BusOptions bus;
  std::int64_t session = 0;
  double patience = 10;    ///< s
  double first_wait = 60;  ///< s
  bool real_time = false;
  RealTimeWishes wishes;
  Evaluation evaluation = Evaluation::machine_code;

  nanoseconds patience_ns() const { return nanoseconds(static_cast<std::int64_t>(patience * 1e9)); }
  nanoseconds first_wait_ns() const { return nanoseconds(static_cast<std::int64_t>(first_wait * 1e9)); }
  /// The experiment as this line overrides it.
  Experiment load() const;
  /// In real time: takes what rights there are, and says on stderr what is lost, unless `mixloop run`
  /// launched this process (its plant says it). `below`: by how much its priority is less than the line's.
  void take_rights(const char* program, bool say, int below = 0) const;
  /// Says on stderr for whom it waits, and how long: a person started it.
  void say_waiting(const char* program, const char* whom, const char* channel) const;
};
void add_peer_options(CLI::App& command, PeerLine& line);

}  // namespace mixloop
