// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "report/reported_run.hpp"

namespace mixloop {

/// A number as pages and results have it: null where it isn't finite, which JSON can't say.
nlohmann::ordered_json number_or_null(double value);

/// A page bundled by web/, with its data put in. Throws RunFault("missing_part") where `page` has no place
/// for it.
std::string with_data(const std::string& page, const nlohmann::ordered_json& data);

/// What the report's page shows: {"mixloop", "runs": [...], "curves"}; web/report/main.js reads it. The same
/// runs give the same text.
nlohmann::ordered_json page_data(const std::vector<ReportedRun>& runs);

/// The report of these runs, below `most_bytes`: curves are coarsened where they must.
std::string report_page(const std::string& page, std::vector<ReportedRun>& runs, std::size_t most_bytes);

}  // namespace mixloop
