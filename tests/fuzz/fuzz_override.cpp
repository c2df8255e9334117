// SPDX-License-Identifier: MIT
// `PATH=VALUE` in the first line, applied to the document in the others.
#include "notation/document.hpp"
#include "tests/fuzz/check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mixloop;
  const std::string_view text = text_of(data, size);
  const auto line_end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, line_end);
  const auto equals = std::min(line.find('='), line.size());
  refuses_or_reads("", [&] {
    const NodePtr document = parse_document(text.substr(line_end), "fuzz");
    const NodePtr changed =
        override_entry(document, line.substr(0, equals), line.substr(std::min(equals + 1, line.size())));
    require(changed != nullptr && changed != document, "an override makes a new document");
  });
  return 0;
}
