// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

#include "notation/errors.hpp"
#include "notation/utf8.hpp"

/// What libFuzzer calls with every input, and tests/fuzz/replay.cpp with every file of the corpus.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace mixloop {

/// A property that held for no input may break: ends the process, which both callers report as a finding.
inline void require(bool holds, const char* property) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", property);
  std::abort();
}

/// Runs `read`; only an InputError may leave it, with a code, a message that is text, and a place.
template <class Read>
void refuses_or_reads(std::string_view file, const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    const std::string what = error.what();
    require(!error.code.empty(), "an error has a code");
    require(!first_non_text(what), "a message is text");
    require(what.size() < 4096, "a message is short");
    require(error.place.file.find(file) != std::string::npos, "an error names the file");
    require(error.place.line >= 0 && error.place.column >= 0, "a place counts from 1");
  }
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace mixloop
