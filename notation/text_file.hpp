// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace mixloop {

/// The first `most` bytes of a file. Throws InputError("no_such_file") for none, a directory, or one that
/// can't be read.
std::string read_file(const std::filesystem::path& path, std::size_t most);

/// Throws InputError("too_large") for a text of more than `most` bytes, and "not_text", with line and column,
/// for bytes that belong in none. `expected`: what it should be, for the messages.
void require_text(std::string_view text, std::size_t most, const std::string& expected,
                  const std::string& file);

}  // namespace mixloop
