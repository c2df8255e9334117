// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "mixloop_lcm/fields.hpp"
#include "plant/faults.hpp"
#include "report/tick.hpp"

namespace mixloop {

/// One run of a plant in a log.
struct LogSession {
  std::int64_t session = 0;
  std::int32_t n = 0;              ///< measured coordinates
  std::int32_t n_u = 0;            ///< motors, by COMMAND; 0: there is none
  std::int32_t n_all = 0;          ///< independent coordinates, by TRUTH; 0: there is none
  std::vector<int> measured = {};  ///< which of them n counts; none: the first ones, as far as is known
  std::int64_t states = 0;         ///< STATE messages, those sent again included
  std::int64_t first_tick = 0, last_tick = 0;
  double rate_hz = 0;  ///< as tick and plant time tell it
};

/// What a log holds beside its ticks.
struct LogFacts {
  std::int64_t states_missing = 0, commands_missing = 0, references_missing = 0;  ///< ticks without
  std::int64_t dropped = 0;  ///< messages that can't be read
  bool has_truth = false, is_real_time = false, reached_safe_state = false;
  std::vector<timing_t> timing;
  std::vector<std::pair<std::int64_t, Fault>>
      faults;          ///< that an operator ordered, by the tick last heard then
  std::string damage;  ///< of the file, for a person; empty where there is none
};

/// The sessions of a log, those with the most states first. Throws what LogReader throws, and InputError
/// `no_states` where no channel PREFIXSTATE has one of ours.
std::vector<LogSession> sessions_in(const std::filesystem::path& log, const std::string& prefix);

/// Calls `on_tick` for each tick of a session from its first to its last, gaps included; it may complete the
/// tick. Without TRUTH the torque applied is the commanded one, and the motors' work is that of a torque held
/// from tick to tick. `rate_hz` and `sizes`: as the session tells them, or better known.
LogFacts read_log(const std::filesystem::path& log, const std::string& prefix, const LogSession& session,
                  double rate_hz, const RunSizes& sizes, const std::function<void(Tick&)>& on_tick);

}  // namespace mixloop
