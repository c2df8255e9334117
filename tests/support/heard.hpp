// SPDX-License-Identifier: MIT
#pragma once

#include <fstream>
#include <functional>
#include <string>

#include "runtime/bus/bus.hpp"
#include "runtime/bus/wire.hpp"

namespace mixloop {

/// How many processes of this network namespace listen on the bus.
inline int listeners() {
  int count = 0;
  std::ifstream sockets("/proc/net/udp");
  for (std::string line; std::getline(sockets, line);)
    if (line.find(":1DF3 ") != std::string::npos) ++count;  // LCM's port, 7667
  return count;
}

/// Waits until a channel, named without its prefix, has had so many messages; false after a minute.
inline bool heard(const char* channel, int times) {
  Bus bus;
  int count = 0;
  bus.subscribe(
      bus.channel(channel), [](void* counter, const Received&) { ++*static_cast<int*>(counter); }, &count);
  const StopSwitch never;
  for (const Instant until = now() + std::chrono::minutes(1); count < times && now() < until;)
    bus.wait(until, never);
  return count >= times;
}

/// Waits for a STATE that fulfils a condition; false after a minute.
inline bool heard_state(std::function<bool(const state_t&)> condition) {
  struct Ear {
    void on_state(Bytes bytes) {
      state_t state;
      if (state.decode(bytes.data(), 0, static_cast<int>(bytes.size())) > 0) fulfilled = condition(state);
    }
    std::function<bool(const state_t&)> condition;
    bool fulfilled = false;
  } ear{.condition = std::move(condition)};
  Bus bus;
  bus.subscribe<&Ear::on_state>(bus.channel("STATE"), &ear);
  const StopSwitch never;
  for (const Instant until = now() + std::chrono::minutes(1); !ear.fulfilled && now() < until;)
    bus.wait(until, never);
  return ear.fulfilled;
}

inline bool heard_tick(std::int64_t tick) {
  return heard_state([tick](const state_t& state) { return state.seq >= tick; });
}

inline bool heard_safe_state() {
  return heard_state([](const state_t& state) { return (state.flags & state_t::FLAG_SAFE_STATE) != 0; });
}

}  // namespace mixloop
