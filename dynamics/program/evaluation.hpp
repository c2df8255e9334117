// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

namespace mixloop {

/// How the equations of motion are evaluated, the slowest way first.
enum class Evaluation : std::uint8_t {
  reference,     ///< the procedure as it stands, on doubles
  interpreter,   ///< the scene's programs, interpreted; by the procedure those too long to trace
  machine_code,  ///< the scene's programs, compiled; interpreted where there is no compiler, and those too
                 ///< long to compile (kMostCompiledOperations)
};

/// Its word on command lines and in results.
constexpr std::string_view name_of(Evaluation how) {
  return how == Evaluation::reference     ? "reference"
         : how == Evaluation::interpreter ? "interpreter"
                                          : "machine_code";
}

}  // namespace mixloop
