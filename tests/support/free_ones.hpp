// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mixloop {

/// A scene's text, `motors: [...]` in one line, with a motor less in each place behind the first `motors`:
/// what stood there moves freely.
inline std::string with_free_ones(std::string text, int motors) {
  std::size_t at = text.find("motors: [");
  for (int i = 0; i < motors; ++i) at = text.find(", ", at + 1);
  return text.replace(at, 2, "]\nfree: [");
}

}  // namespace mixloop
