// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "runtime/clock/clock.hpp"
#include "runtime/protocol/config_hash.hpp"

namespace mixloop {

/// What a plant on the bus is told, in lockstep and in real time.
struct PlantOptions {
  int n = 0;                   ///< measured coordinates: what the plant's messages count, but for TRUTH
  int unmeasured = 0;          ///< independent coordinates beside them, which TRUTH counts too
  int n_u = 0;                 ///< motors: what COMMAND's n counts
  std::int64_t last_tick = 0;  ///< N: ticks 0 to N are run
  bool references = true;      ///< there is a planner: not without a path
  double rate_hz = 1000;       ///< tick k is plant time k / rate_hz
  double speed = 0;            ///< plant seconds a real second; 0: as fast as it goes
  std::int64_t session = 0;    ///< 0: draw one
  std::int64_t config = 0;     ///< see config_hash.hpp
  ConfigWords config_words;    ///< what it is of
  bool truth = false;          ///< publish TRUTH
  bool hold = false;           ///< go on past the last tick until stopped
  bool paused = false;         ///< begin paused, at tick 0
  int max_missed = 20;         ///< real time: so many ticks are forgiven
  nanoseconds first_resend = std::chrono::milliseconds(5);  ///< STATE again after this silence, then doubling
  nanoseconds slowest_resend = std::chrono::milliseconds(100);
  nanoseconds first_wait = std::chrono::seconds(60);  ///< for the command of tick 0
  nanoseconds patience = std::chrono::seconds(10);    ///< for any later one
  /// Told of what a person should look after, as of a second sender: at most once of each kind. Optional.
  std::function<void(const std::string&)> notice;
};

}  // namespace mixloop
