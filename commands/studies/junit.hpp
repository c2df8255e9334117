// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include "loop/result.hpp"

namespace mixloop {

/// Writes results of `track` as a JUnit test report, a test case each. Throws RunFault("cannot_write").
void write_junit(const std::string& file, std::span<const Result> results);

}  // namespace mixloop
