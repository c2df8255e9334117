// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace mixloop {

/// Counts heap allocations (malloc, calloc, realloc, aligned ones, and so operator new) of all threads of the
/// process while it lives. Linking it interposes malloc in the test's executable.
class AllocationCounter {
 public:
  /// False under a sanitizer, which has its own malloc: skip the test.
  static bool works();

  AllocationCounter();   ///< starts from zero; one at a time
  ~AllocationCounter();  ///< stops
  AllocationCounter(const AllocationCounter&) = delete;
  AllocationCounter& operator=(const AllocationCounter&) = delete;

  std::uint64_t count() const;
  /// The code address that asked for the first one, for addr2line; null where there was none.
  const void* first_caller() const;
};

}  // namespace mixloop
