// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "sweep/sweep.hpp"

namespace mixloop {

/// One of the parts that a sweep is split into: `index` of 0 to `of` - 1; all of it is part 0 of 1.
struct Part {
  std::int64_t index = 0, of = 1;
  bool is_whole() const { return of == 1; }
};

/// "process 123 on host".
std::string own_name();

/// A file that one process at a time may have.
class FileLock {
 public:
  enum class Kind { alone, shared };
  /// Throws InputError("in_use") with the process that has it, RunFault("cannot_write").
  FileLock(std::filesystem::path file, Kind kind, bool waits = false);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int descriptor_;
};

/// All journals that a sweep's folder has.
std::vector<std::filesystem::path> journals_in(const std::filesystem::path& folder);

/// The folder of a sweep's results, taken while it lives: the whole of it, or beside other parts one part.
///
/// | file | |
/// |---|---|
/// | sweep.yaml | what was asked for: what the table depends on |
/// | asked.yaml | the same in full, for who reads the runs without the experiment (KeptSweep) |
/// | journal, journal.2-of-8 | what became of runs, as they came |
/// | lock, lock.2-of-8 | who is at work |
/// | table.csv, table.h5 | of all runs, once they are all there |
class SweepFolder {
 public:
  /// Makes it where there is none. Throws InputError: "another_sweep" with what differs where it holds one of
  /// other settings, "in_use" where another process works in it; RunFault("cannot_write").
  SweepFolder(std::filesystem::path folder, const Sweep& sweep, const Part& part);

  const std::filesystem::path& path() const { return folder_; }
  std::filesystem::path journal() const;
  /// All that there are.
  std::vector<std::filesystem::path> journals() const { return journals_in(folder_); }

 private:
  void keep_settings(const Sweep& sweep) const;
  std::string suffix() const;

  std::filesystem::path folder_;
  Part part_;
  std::vector<std::unique_ptr<FileLock>> locks_;
};

}  // namespace mixloop
