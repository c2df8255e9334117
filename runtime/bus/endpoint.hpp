// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace mixloop {

/// Where a datagram came from: each LCM instance sends from a port of its own.
struct Endpoint {
  std::uint32_t address = 0;  ///< IPv4, the first number in the highest byte; 0: unknown
  std::uint16_t port = 0;
  bool operator==(const Endpoint&) const = default;
};

/// As "10.0.0.2:41234"; of this machine's own, where a loopback has no address to send from, "port 41234".
inline std::string to_string(const Endpoint& endpoint) {
  if (endpoint.address == 0) return "port " + std::to_string(endpoint.port);
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8)
    text += std::to_string(endpoint.address >> shift & 0xff) + (shift > 0 ? "." : ":");
  return text + std::to_string(endpoint.port);
}

}  // namespace mixloop
