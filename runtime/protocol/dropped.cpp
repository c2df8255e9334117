// SPDX-License-Identifier: MIT
#include "runtime/protocol/dropped.hpp"

#include <fmt/format.h>

#include "runtime/protocol/config_hash.hpp"

namespace mixloop {
namespace {

/// What was found, by the latest of that cause, and what was expected.
std::string found(Reject cause, const Header& latest, const Header& expected) {
  switch (cause) {
    case Reject::length:
      return "another length than its type has";
    case Reject::fingerprint:
      return "another type, or another version of it";
    case Reject::dimension:
      return fmt::format("n is {}, expected {}", latest.n, expected.n);
    case Reject::not_finite:
      return "NaN or infinity";
    case Reject::session:
      return fmt::format("{}, expected {}", latest.session, expected.session);
    case Reject::config:
      return "another " + name_difference(expected.config, latest.config);
    case Reject::tick:
      return fmt::format("{}, which can't be; expected {}", latest.seq, expected.seq);
    case Reject::sender:
      return "not from who had sent them in this session";
    case Reject::stale:
      break;
  }
  return fmt::format("{}, which is over; expected {}", latest.seq, expected.seq);
}

}  // namespace

void Dropped::count(Reject cause, Bytes bytes) {
  rejects_.count(cause);
  if (const auto header = peek(bytes)) latest_[static_cast<std::size_t>(cause)] = *header;
}

bool Dropped::are_answers() const {
  return rejects_.total() > rejects_.of(Reject::stale) + rejects_.of(Reject::session);
}

std::string Dropped::text(const Header& expected) const {
  std::string words;
  for (const RejectRow& row : kRejects)
    if (const auto number = rejects_.of(row.cause); number > 0)
      words += fmt::format("{}{} {} ({})", words.empty() ? "" : ", ", number, row.name,
                           found(row.cause, latest_[static_cast<std::size_t>(row.cause)], expected));
  return words;
}

}  // namespace mixloop
