// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "library/inside.hpp"

namespace mixloop::v1 {

Error::Error(std::string code, Place place, std::string message)
    : std::runtime_error(InputError(code, {place.file, place.line, place.column}, message).what()),
      code_(std::move(code)),
      place_(std::move(place)),
      message_(std::move(message)) {}

Error::~Error() = default;

const char* version() noexcept { return MIXLOOP_VERSION; }

}  // namespace mixloop::v1

namespace mixloop::inside {

void require_size(const char* what, std::size_t found, std::size_t expected) {
  if (found != expected)
    throw v1::Error("wrong_size", {}, fmt::format("{} has {} numbers; expected {}", what, found, expected));
}

}  // namespace mixloop::inside
