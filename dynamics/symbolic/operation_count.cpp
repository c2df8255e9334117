// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/operation_count.hpp"

namespace mixloop {

std::string OperationCount::text() const {
  std::string result;
  auto say = [&](std::size_t count, const char* name) {
    if (count > 0) result += (result.empty() ? "" : " + ") + std::to_string(count) + " " + name;
  };
  say(add, "add"), say(mul, "mul"), say(div, "div"), say(sqrt, "sqrt"), say(other, "exp/log/atan2"),
      say(sincos, "sincos");
  if (fused > 0) result += ", " + std::to_string(fused) + " fused";
  return result.empty() ? "nothing" : result;
}

}  // namespace mixloop
