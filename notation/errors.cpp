// SPDX-License-Identifier: MIT
#include "notation/errors.hpp"

#include <utility>

#include "notation/utf8.hpp"

namespace mixloop {

std::string to_string(const Place& place) {
  std::string text = printable_name(place.file);
  if (place.line > 0) text += ":" + std::to_string(place.line);
  if (place.line > 0 && place.column > 0) text += ":" + std::to_string(place.column);
  return text;
}

InputError::InputError(std::string code_, const Place& place_, const std::string& message_)
    : std::runtime_error((place_.file.empty() ? "" : to_string(place_) + ": ") + printable(message_)),
      code(std::move(code_)),
      place(place_),
      message(printable(message_)) {}

RunFault::RunFault(std::string code_, const std::string& message)
    : std::runtime_error(printable(message)), code(std::move(code_)) {}

}  // namespace mixloop
