// SPDX-License-Identifier: MIT
#include "processes/speed.hpp"

#include "notation/value.hpp"

namespace mixloop {

double speed_of(const std::string& text) {
  if (text == "max") return 0;
  const double speed = number_of(*parse_document(text, "--speed"), kPure, "the speed");
  if (!(speed > 0))
    throw InputError("out_of_range", {"--speed"},
                     "'" + text + "'; expected max or a positive factor of real time, e.g. 0.1, 1, 10");
  return speed;
}

}  // namespace mixloop
