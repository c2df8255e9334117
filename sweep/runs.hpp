// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace mixloop {

/// Some runs in a row.
struct Runs {
  std::int64_t first = 0, count = 0;

  std::int64_t end() const { return first + count; }
  bool operator==(const Runs&) const = default;
};

/// Those of runs 0 to `all` - 1 that none of `done` has, in order; `done` may overlap and lie anyhow.
std::vector<Runs> without(std::int64_t all, std::vector<Runs> done);

/// A share of a sweep's runs: batches of `batch` runs, of which every `of`th is taken, from number `index`
/// on.
struct Share {
  std::int64_t batch = 1, index = 0, of = 1;
};

/// How many runs are worth handing out at a time, `least` at least.
std::int64_t batch_for(std::int64_t runs, std::int64_t least = 1);

/// Hands out runs that are to be done, a batch or what is left of it at a time. One thread at a time.
class Dispenser {
 public:
  Dispenser(std::vector<Runs> pending, const Share& share) : pending_(std::move(pending)), share_(share) {}

  /// None where all are handed out.
  Runs next();
  /// How many it hands out in all.
  std::int64_t total() const;

 private:
  std::vector<Runs> pending_;
  Share share_;
  std::size_t at_ = 0;
};

}  // namespace mixloop
