// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mixloop {

/// The text of a page that web/ bundled, e.g. "report.html": share/mixloop beside this executable's bin.
/// Throws RunFault("missing_part") with what mends it.
std::string web_page(const std::string& name);

}  // namespace mixloop
