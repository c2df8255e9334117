// SPDX-License-Identifier: MIT
#include "processes/speed.hpp"

#include "notation/value.hpp"
#include "runtime/protocol/conductor.hpp"

namespace mixloop {

double speed_of(const std::string& text) {
  if (text == "max") return 0;
  const double speed = number_of(*parse_document(text, "--speed"), kPure, "the speed");
  if (!(speed > 0))
    throw InputError("out_of_range", {"--speed"},
                     "'" + text + "'; expected max or a positive factor of real time, e.g. 0.1, 1, 10");
  if (const char* reason = objection_to_speed(speed, false))
    throw InputError("out_of_range", {"--speed"}, "'" + text + "'; " + reason);
  return speed;
}

}  // namespace mixloop
