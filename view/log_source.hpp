// SPDX-License-Identifier: MIT
#pragma once

#include "report/run_file.hpp"
#include "view/source.hpp"

namespace mixloop {

/// A run that is over, from a log or a kept result, in memory: the page asks for the tick that it shows.
class LogSource : public Source {
 public:
  /// Throws what open_run and read_ticks throw, and InputError where no scene is known.
  LogSource(const std::filesystem::path& path, const ReadOptions& options);

  std::string description() override { return description_; }
  std::int64_t version() override { return 0; }
  std::string newest(Cursor& cursor) override;
  std::string at_tick(std::int64_t k) override;

 private:
  void keep(const Tick& tick);

  RunFile run_;
  std::vector<double> rows_;  ///< a tick each: psi (n), tau (n_u), desired (3)
  Skeleton skeleton_;
  Traces traces_;
  std::string description_;
};

}  // namespace mixloop
