// SPDX-License-Identifier: MIT
#include "runtime/protocol/plant_runner.hpp"

namespace mixloop {

Ending PlantRunner::run() {
  try {
    const Ending ending = run_ticks();
    if (ending != Ending::reset) port_.send_end(ending);
    return ending;
  } catch (...) {
    port_.send_end(Ending::broken_off);
    throw;
  }
}

Ending PlantRunner::ending_at(std::int64_t tick, PlantPort::Answer answer) const {
  using Answer = PlantPort::Answer;
  if (answer == Answer::reset) return Ending::reset;
  if (tick > options_.last_tick) return Ending::finished;
  return answer == Answer::interrupted ? Ending::interrupted : Ending::stopped;
}

}  // namespace mixloop
