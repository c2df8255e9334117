// SPDX-License-Identifier: MIT
#include "runtime/bus/rejects.hpp"

namespace mixloop {

std::string to_string(const Rejects& rejects) {
  std::string words;
  for (const RejectRow& row : kRejects)
    if (const auto number = rejects.of(row.cause); number > 0)
      words += (words.empty() ? "" : ", ") + std::to_string(number) + " " + std::string(row.name);
  return words;
}

}  // namespace mixloop
