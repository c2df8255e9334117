// SPDX-License-Identifier: MIT
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

#include "runtime/bus/bus.hpp"
#include "runtime/bus/multicast_route.hpp"

namespace mixloop {

/// Sends bytes as they are to the group, which no LCM may.
inline void send_datagram(const std::string& datagram) {
  const MulticastGroup group = multicast_group(BusOptions{}.url);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(group.port));
  inet_pton(AF_INET, group.address.c_str(), &to.sin_addr);
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  EXPECT_EQ(sendto(fd, datagram.data(), datagram.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof to),
            static_cast<ssize_t>(datagram.size()));
  close(fd);
}

}  // namespace mixloop
