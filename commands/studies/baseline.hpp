// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "loop/result.hpp"

namespace mixloop {

/// What runs measured last time, by name: errors in m, torques in N m or N.
class Baseline {
 public:
  /// Reads the file, or nothing where there is none. Throws InputError("not_a_baseline").
  explicit Baseline(std::string file);

  /// What of a run is worse than last time by more than a part of it, in words; nothing where it is new.
  std::vector<std::string> worse(const Result& result, double part) const;

  /// Keeps what these runs measured, in place of their last; what others did stays. Throws
  /// RunFault("cannot_write").
  void keep(std::span<const Result> results);

 private:
  using Measured = std::map<std::string, double>;

  std::string file_;
  std::map<std::string, Measured> runs_;
};

}  // namespace mixloop
