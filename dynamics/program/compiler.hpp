// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace mixloop {

/// A compiler of this machine, and how it makes a shared object of one source file.
struct Compiler {
  std::filesystem::path path;
  std::string identity;  ///< changes when the compiler does: file, size and time of modification
  std::vector<std::string> flags;
  const char* suffix = ".cpp";  ///< of what it compiles
};

/// $MIXLOOP_CXX (empty: none), else $CXX, else c++, g++ or clang++ on the PATH; nullopt if there is none.
std::optional<Compiler> find_compiler();

/// The same for graphics processors: $MIXLOOP_NVCC (empty: none), else nvcc on the PATH or where CUDA
/// installs it.
std::optional<Compiler> find_cuda_compiler();

/// The flags that machine code is built with. No contraction: products and sums round separately, so that
/// machine code and interpreter give the same bits.
const std::vector<std::string>& machine_code_flags();

/// Builds a shared object from one source file. False on failure; `complaint` then has what the compiler
/// said, shortened.
bool build_shared_object(const Compiler& compiler, const std::filesystem::path& source,
                         const std::filesystem::path& result, std::string& complaint);

}  // namespace mixloop
