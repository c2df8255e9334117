// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

namespace mixloop {

/// Whether a request's Host is this server by one of its own names: 127.0.0.1:PORT or localhost:PORT. Any
/// other name that leads here is a page elsewhere whose name was bent to 127.0.0.1.
bool host_is_ours(std::string_view host, std::uint16_t port);

/// Whether an Origin is a page of this server's; one that is missing is not.
bool origin_is_ours(std::string_view origin, std::uint16_t port);

}  // namespace mixloop
