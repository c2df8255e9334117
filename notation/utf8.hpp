// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace mixloop {

/// Offset of the first byte that belongs in no text file: invalid UTF-8 or a control character other than
/// tab, line feed and carriage return. Nothing when all of it is text, so messages and JSON may quote it.
std::optional<std::size_t> first_non_text(std::string_view bytes);

/// `text` as a terminal, JSON and XML may have it: control characters, which a terminal could obey, and bytes
/// that are no UTF-8 stand as \xNN. Line feeds and tabs stay.
std::string printable(std::string_view text);
/// The same on one line: of a name.
std::string printable_name(std::string_view text);

/// `text`, printable, in single quotes, on one line, cut (between characters) to at most `most` bytes and
/// "...".
std::string in_quotes(std::string_view text, std::size_t most = 60);

}  // namespace mixloop
