// SPDX-License-Identifier: MIT
#include "view/request_check.hpp"

#include <fmt/format.h>

namespace mixloop {

bool host_is_ours(std::string_view host, std::uint16_t port) {
  return host == fmt::format("127.0.0.1:{}", port) || host == fmt::format("localhost:{}", port);
}

bool origin_is_ours(std::string_view origin, std::uint16_t port) {
  constexpr std::string_view kScheme = "http://";
  return origin.starts_with(kScheme) && host_is_ours(origin.substr(kScheme.size()), port);
}

}  // namespace mixloop
