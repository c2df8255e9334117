// SPDX-License-Identifier: MIT
#include "notation/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "notation/errors.hpp"
#include "notation/utf8.hpp"

namespace mixloop {

std::string read_file(const std::filesystem::path& path, std::size_t most) {
  std::error_code failure;
  if (!std::filesystem::exists(path, failure))
    throw InputError("no_such_file", {path.string()}, "no such file");
  if (std::filesystem::is_directory(path, failure))
    throw InputError("no_such_file", {path.string()}, "found a directory; expected a file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError("no_such_file", {path.string()}, "cannot be read");
  std::string text(most, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

void require_text(std::string_view text, std::size_t most, const std::string& expected,
                  const std::string& file) {
  if (text.size() > most)
    throw InputError("too_large", {file}, fmt::format("larger than {} bytes; expected {}", most, expected));
  const auto at = first_non_text(text);
  if (!at) return;
  const std::string_view before = text.substr(0, *at);
  const auto line_start = before.rfind('\n') + 1;  // npos + 1 is 0
  const int line = 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n'));
  throw InputError("not_text", {file, line, static_cast<int>(*at - line_start) + 1},
                   fmt::format("found the byte 0x{:02x}; expected text, {} in UTF-8",
                               static_cast<unsigned char>(text[*at]), expected));
}

}  // namespace mixloop
