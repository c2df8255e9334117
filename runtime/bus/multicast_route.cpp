// SPDX-License-Identifier: MIT
#include "runtime/bus/multicast_route.hpp"

#include <arpa/inet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>

#include "notation/errors.hpp"

namespace mixloop {
namespace {

bool loopback_is_up(int socket) {
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  return ioctl(socket, SIOCGIFFLAGS, &request) == 0 && (request.ifr_flags & IFF_UP) != 0;
}

}  // namespace

MulticastGroup multicast_group(const std::string& url) {
  const auto refuse = [&url] {
    return RunFault("bus_url", "the bus url is '" + url +
                                   "'; expected udpm://ADDRESS:PORT, then perhaps ?ttl=N, ADDRESS being a "
                                   "multicast group, as in udpm://239.255.76.67:7667?ttl=0");
  };
  constexpr std::string_view kScheme = "udpm://";
  if (!url.starts_with(kScheme)) throw refuse();
  const std::string network = url.substr(kScheme.size(), url.find('?') - kScheme.size());
  const std::size_t colon = network.find(':');
  if (colon == std::string::npos) throw refuse();

  MulticastGroup group{.address = network.substr(0, colon)};
  const char* end = network.data() + network.size();
  const auto [stopped, error] = std::from_chars(network.data() + colon + 1, end, group.port);
  in_addr address{};
  if (error != std::errc() || stopped != end || group.port < 1 || group.port > 65535 ||
      inet_pton(AF_INET, group.address.c_str(), &address) != 1 || !IN_MULTICAST(ntohl(address.s_addr)))
    throw refuse();
  return group;
}

void require_multicast_route(const MulticastGroup& group) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) throw RunFault("bus", std::string("no UDP socket: ") + std::strerror(errno));
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(group.port));
  inet_pton(AF_INET, group.address.c_str(), &to.sin_addr);
  const bool reachable = connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  const int cause = errno;
  const bool loopback = loopback_is_up(fd);
  close(fd);
  if (reachable) return;
  throw RunFault("no_multicast_route",
                 "cannot send to " + group.address + ": " + std::strerror(cause) +
                     "; the loopback interface is " +
                     (loopback ? "up, and no route leads to multicast addresses" : "down") +
                     ". As root:\n  ip link set lo up\n  ip route add 224.0.0.0/4 dev lo\n"
                     "or run the same command in a network namespace of its own, without root: "
                     "mixloop netns COMMAND...");
}

}  // namespace mixloop
