// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace mixloop {

/// A curve of any length in bounded memory, its peaks kept: the least and the greatest of each bucket of
/// `width()` consecutive values. A value that is not a number is a gap.
class Envelope {
 public:
  /// Holds up to `capacity` buckets (even, 2 or more); when they are full the width doubles.
  explicit Envelope(std::size_t capacity);

  void add(double value);
  /// Half as many buckets, twice as wide.
  void coarsen();

  std::int64_t width() const { return width_; }  ///< values a bucket, a power of two
  bool empty() const { return !seen_; }          ///< nothing but gaps
  /// With a width of 1 the values; else of each bucket its least and greatest, in the order in which they
  /// came.
  std::vector<float> points() const;

 private:
  struct Bucket {
    float least, greatest;
    bool falls;  ///< the greatest came first
  };
  static Bucket joined(const Bucket& first, const Bucket& second);

  std::size_t capacity_;
  std::vector<Bucket> buckets_;
  std::int64_t width_ = 1;
  std::int64_t in_last_ = 0;  ///< values in the last bucket
  bool seen_ = false;
};

}  // namespace mixloop
