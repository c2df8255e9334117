// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>

#include "runtime/bus/wire.hpp"

namespace mixloop {

/// The messages of a channel that came while an answer was awaited there, and were dropped.
class Dropped {
 public:
  void count(Reject cause, Bytes bytes);
  void forget() { *this = {}; }

  const Rejects& rejects() const { return rejects_; }
  /// Whether somebody answers whose answers can't be taken: not only late, doubled or another run's.
  bool are_answers() const;
  /// As "60 not_finite (NaN or infinity), 7 dimension (n is 2, expected 3)"; `expected` of an answer.
  std::string text(const Header& expected) const;

 private:
  Rejects rejects_;
  std::array<Header, kRejects.size()> latest_{};  ///< by cause
};

}  // namespace mixloop
