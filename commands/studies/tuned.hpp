// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tuning/tune.hpp"

namespace mixloop {

/// What `mixloop tune` has to tell of a search.
struct TuneStory {
  const Problem* problem = nullptr;
  Tuned tuned;
  Problem::Alone before, after;       ///< the experiment and the tuned one by themselves
  std::vector<std::string> warnings;  ///< of the tuned experiment
  std::string file, picture;          ///< written; empty: nothing was

  /// 1: nothing holds the bounds, or the tuned experiment misses what it expects.
  int exit_status() const;
};

/// To people, and as JSON; the same bytes whenever the search was.
std::string summary(const TuneStory& story);
nlohmann::json json_of(const TuneStory& story);

/// What the tuned experiment's file begins with.
std::string head_of(const TuneStory& story);

}  // namespace mixloop
