// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sweep/reduction/reduction.hpp"

namespace mixloop {

/// What the page of a sweep shows; web/sweep/main.js reads it. `expect`: of its summary, what was expected of
/// shares of the runs. The same runs give the same text.
nlohmann::ordered_json sweep_page_data(const KeptSweep& sweep, const Reduction& reduction,
                                       const nlohmann::ordered_json& expect,
                                       const std::vector<std::string>& notes);

}  // namespace mixloop
