// SPDX-License-Identifier: MIT
#include "notation/errors.hpp"

namespace mixloop {

std::string to_string(const Place& place) {
  std::string text = place.file;
  if (place.line > 0) text += ":" + std::to_string(place.line);
  if (place.line > 0 && place.column > 0) text += ":" + std::to_string(place.column);
  return text;
}

InputError::InputError(std::string code_, const Place& place_, const std::string& message_)
    : std::runtime_error(place_.file.empty() ? message_ : to_string(place_) + ": " + message_),
      code(std::move(code_)),
      place(place_),
      message(message_) {}

}  // namespace mixloop
