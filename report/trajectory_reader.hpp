// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "report/tick.hpp"

namespace mixloop {

/// A kept trajectory.csv, read line by line. Columns are found by their names; what is missing stays unknown,
/// what is not known here is passed over.
class TrajectoryReader {
 public:
  /// Reads the header. Throws InputError `cannot_read` or `not_a_trajectory`, with the place.
  explicit TrajectoryReader(const std::filesystem::path& file);
  ~TrajectoryReader();
  TrajectoryReader(const TrajectoryReader&) = delete;
  TrajectoryReader& operator=(const TrajectoryReader&) = delete;

  /// By the columns psi_ and tau_; m is not told.
  const RunSizes& sizes() const { return sizes_; }
  /// Calls `on_tick` for every line, k counting from 0; it may complete the tick. Throws InputError for a
  /// line that has not as many numbers as the header has names.
  void read(std::size_t m, const std::function<void(Tick&)>& on_tick);

 private:
  std::filesystem::path file_;
  std::string_view text_;  ///< of the whole file, mapped
  std::size_t at_ = 0;     ///< behind the header
  std::vector<std::string_view> names_;
  RunSizes sizes_;
};

}  // namespace mixloop
