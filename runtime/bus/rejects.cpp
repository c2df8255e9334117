// SPDX-License-Identifier: MIT
#include "runtime/bus/rejects.hpp"

namespace mixloop {

namespace {

std::string words(const auto& number_of) {
  std::string text;
  for (const RejectRow& row : kRejects)
    if (const auto number = number_of(row); number > 0)
      text += (text.empty() ? "" : ", ") + std::to_string(number) + " " + std::string(row.name);
  return text;
}

}  // namespace

std::string to_string(const Rejects& rejects) {
  return words([&](const RejectRow& row) { return rejects.of(row.cause); });
}

std::string dropped_in(const timing_t& timing) {
  return words([&](const RejectRow& row) { return timed(timing, row); });
}

}  // namespace mixloop
