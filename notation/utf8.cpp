// SPDX-License-Identifier: MIT
#include "notation/utf8.hpp"

#include <algorithm>

namespace mixloop {
namespace {

unsigned char byte_at(std::string_view bytes, std::size_t i) { return static_cast<unsigned char>(bytes[i]); }

bool continues(std::string_view bytes, std::size_t i) { return (byte_at(bytes, i) & 0xc0) == 0x80; }

/// Length of the UTF-8 character that begins at `i`, 0 where none does.
std::size_t character_length(std::string_view bytes, std::size_t i) {
  const unsigned char lead = byte_at(bytes, i);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || bytes.size() - i < length) return 0;
  for (std::size_t k = 1; k < length; ++k)
    if (!continues(bytes, i + k)) return 0;
  const unsigned char second = byte_at(bytes, i + 1);
  const bool overlong = (lead == 0xe0 && second < 0xa0) || (lead == 0xf0 && second < 0x90);
  const bool surrogate = lead == 0xed && second > 0x9f;
  const bool past_the_last = lead == 0xf4 && second > 0x8f;
  return overlong || surrogate || past_the_last ? 0 : length;
}

bool is_control(std::string_view bytes, std::size_t i) {
  const unsigned char byte = byte_at(bytes, i);
  if (byte == 0xc2) return byte_at(bytes, i + 1) < 0xa0;  // U+0080 to U+009F, terminals obey some
  return (byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r') || byte == 0x7f;
}

/// `text` with what is no text, and white space other than `kept` and the blank, as \xNN.
std::string without(std::string_view text, std::string_view kept) {
  std::string shown;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = character_length(text, i);
    const unsigned char byte = byte_at(text, i);
    const bool is_space = byte == '\t' || byte == '\n' || byte == '\r';
    if (length == 0 || is_control(text, i) || (is_space && kept.find(text[i]) == std::string_view::npos)) {
      constexpr const char* kDigits = "0123456789abcdef";
      for (std::size_t end = i + std::max<std::size_t>(length, 1); i < end; ++i)
        shown.append("\\x")
            .append(1, kDigits[byte_at(text, i) >> 4])
            .append(1, kDigits[byte_at(text, i) & 15]);
    } else {
      shown += text.substr(i, length);
      i += length;
    }
  }
  return shown;
}

}  // namespace

std::optional<std::size_t> first_non_text(std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size();) {
    const std::size_t length = character_length(bytes, i);
    if (length == 0 || is_control(bytes, i)) return i;
    i += length;
  }
  return std::nullopt;
}

std::string printable(std::string_view text) { return without(text, "\n\t"); }

std::string printable_name(std::string_view text) { return without(text, ""); }

std::string in_quotes(std::string_view bytes, std::size_t most) {
  const std::string text = without(bytes, "\n\r\t");
  std::size_t end = std::min(text.size(), most);
  while (end > 0 && end < text.size() && continues(text, end)) --end;
  std::string shown = text.substr(0, end);
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  return "'" + shown + (end < text.size() ? "...'" : "'");
}

}  // namespace mixloop
