// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mixloop {

inline std::string bin(const std::string& name) { return MIXLOOP_BIN "/" + name; }
inline std::string experiment(const std::string& name) {
  return MIXLOOP_SOURCE "/experiments/" + name + ".yaml";
}
inline std::string robot() { return MIXLOOP_SOURCE "/scenes/mixed_loop_robot.yaml"; }

}  // namespace mixloop
