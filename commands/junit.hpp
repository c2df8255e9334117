// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace mixloop {

/// Writes results of `track` as a JUnit test report, a test case each. Throws RunFault("cannot_write").
void write_junit(const std::string& file, const nlohmann::json& results);

}  // namespace mixloop
