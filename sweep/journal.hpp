// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sweep/outcome.hpp"
#include "sweep/runs.hpp"

namespace mixloop {

/// Bytes of outcomes in a row, and back. Throws std::invalid_argument for what are none.
std::string bytes_of(std::span<const Outcome> outcomes);
std::vector<Outcome> outcomes_in(std::string_view bytes, std::int64_t first, std::size_t values);

/// What became of a sweep's runs, kept as they come: a file to which records of runs in a row are appended,
/// each with a checksum. Whatever ends the process, what was appended stays; a record that was cut off is cut
/// off at the next start. One process at a time has it.
class Journal {
 public:
  /// Opens it, or begins it, for the sweep whose settings have the hash `sweep`. Throws
  /// RunFault("cannot_write"), and InputError("another_sweep") where it is another one's.
  Journal(std::filesystem::path file, const std::string& sweep);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Throws RunFault("cannot_write"); nothing of them is kept then.
  void append(std::span<const Outcome> outcomes);
  /// What was appended outlives the machine's end, too.
  void sync();

 private:
  [[noreturn]] void fail(int error) const;
  void write(std::string_view bytes);

  std::filesystem::path file_;
  int descriptor_;
  std::int64_t size_ = 0;
};

/// What several journals of one sweep keep, in the runs' order.
class KeptRuns {
 public:
  /// Of the files that there are. Throws InputError("another_sweep", "cannot_read").
  KeptRuns(const std::vector<std::filesystem::path>& files, const std::string& sweep, std::size_t values);

  std::vector<Runs> done() const;
  /// Each run that is kept, once, in order. Reads as it goes.
  void each(const std::function<void(const Outcome&)>& told) const;

 private:
  struct Record {
    Runs runs;
    std::size_t file = 0;
    std::int64_t offset = 0, size = 0;  ///< of its outcomes
  };
  std::vector<std::filesystem::path> files_;
  std::size_t values_;
  std::vector<Record> records_;
};

}  // namespace mixloop
