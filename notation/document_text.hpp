// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "notation/document.hpp"

namespace mixloop {

/// The document as YAML that reads back as the same document: mappings in lines of their own down to the
/// second level, what is below and lists on one line.
std::string document_text(const Node& document);

}  // namespace mixloop
