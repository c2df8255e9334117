// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace mixloop {

/// The numbers of a record, zero at first: in memory where they fit there, else in a file on disk that has no
/// name and is gone with them, of which the kernel keeps in memory what it likes.
class RecordRows {
 public:
  /// Throws InputError("too_large") where neither has room; nothing is taken then. `memory`: bytes that may
  /// be taken of it.
  explicit RecordRows(std::size_t count, double memory);
  ~RecordRows();
  RecordRows(const RecordRows&) = delete;
  RecordRows& operator=(const RecordRows&) = delete;

  double* data() { return numbers_.data(); }
  const double* data() const { return numbers_.data(); }
  bool on_disk() const { return on_disk_; }

  /// Where such a file would lie: $TMPDIR, else /var/tmp.
  static std::string folder();
  /// Bytes that are free there.
  static double free_disk();

 private:
  std::span<double> numbers_;
  bool on_disk_;
};

}  // namespace mixloop
