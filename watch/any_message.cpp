// SPDX-License-Identifier: MIT
#include "watch/any_message.hpp"

#include <type_traits>

namespace mixloop {
namespace {

template <class Message>
bool decode_as(Bytes bytes, AnyMessage& kept) {
  if (!std::holds_alternative<Message>(kept)) kept.emplace<Message>();
  return decode(bytes, std::get<Message>(kept));
}

// Calls for the one type whose fingerprint the bytes begin with.
template <class... Messages>
bool decode_by_fingerprint(Bytes bytes, std::variant<std::monostate, Messages...>& kept) {
  return ((fingerprint(bytes) == Messages::getHash() && decode_as<Messages>(bytes, kept)) || ...);
}

}  // namespace

bool decode(Bytes bytes, AnyMessage& kept) {
  // A generated decoder allocates whatever n claims: let that be no more than what is there.
  const auto header = peek(bytes);
  if (!header || header->n < 0 || static_cast<std::size_t>(header->n) > bytes.size() / sizeof(double))
    return false;
  return decode_by_fingerprint(bytes, kept);
}

std::string_view type_name(const AnyMessage& message) {
  return std::visit(
      []<class Message>(const Message&) -> std::string_view {
        if constexpr (std::is_same_v<Message, std::monostate>)
          return "";
        else
          return Message::getTypeName();
      },
      message);
}

}  // namespace mixloop
