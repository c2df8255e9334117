// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include "loop/result.hpp"

namespace mixloop {

/// The JSON's text, well-formed whatever bytes are in its strings: what is no UTF-8 is U+FFFD. `indent`: -1,
/// on one line.
std::string json_text(const nlohmann::json& json, int indent = -1);

/// A result as result.json, --json and the report line have it. What isn't finite is null.
nlohmann::json json_of(const Result& result);

/// A run's result read back. Throws nlohmann::json::exception where it isn't one.
Result result_in(const nlohmann::json& json);

}  // namespace mixloop
