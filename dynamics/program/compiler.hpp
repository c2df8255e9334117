// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace mixloop {

/// The system's C++ compiler.
struct Compiler {
  std::filesystem::path path;
  std::string identity;  ///< changes when the compiler does: file, size and time of modification
};

/// $MIXLOOP_CXX (empty: none), else $CXX, else c++, g++ or clang++ on the PATH; nullopt if there is none.
std::optional<Compiler> find_compiler();

/// The flags that machine code is built with. No contraction: products and sums round separately, so that
/// machine code and interpreter give the same bits.
const std::vector<std::string>& machine_code_flags();

/// Builds a shared object from one source file. False on failure; `complaint` then has what the compiler
/// said, shortened.
bool build_shared_object(const Compiler& compiler, const std::filesystem::path& source,
                         const std::filesystem::path& result, std::string& complaint);

}  // namespace mixloop
