// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "notation/errors.hpp"

namespace mixloop {

/// One step of a path into a document: a key, or an index into a list.
struct PathStep {
  std::string key;
  std::size_t index = 0;
  bool is_index = false;

  bool operator==(const PathStep&) const = default;
};

/// Reads `key`, `.key` and `[index]`, one after the other. Throws InputError("invalid_path") at `place`; 32
/// steps at most.
std::vector<PathStep> path_steps(std::string_view path, const Place& place);

}  // namespace mixloop
