// SPDX-License-Identifier: MIT
#pragma once

#include "runtime/bus.hpp"

namespace mixloop {

/// Waits until a channel, named without its prefix, has had so many messages; false after a minute.
inline bool heard(const char* channel, int times) {
  Bus bus;
  int count = 0;
  bus.subscribe(
      bus.channel(channel), [](void* counter, Bytes) { ++*static_cast<int*>(counter); }, &count);
  const StopSwitch never;
  for (const Instant until = now() + std::chrono::minutes(1); count < times && now() < until;)
    bus.wait(until, never);
  return count >= times;
}

}  // namespace mixloop
