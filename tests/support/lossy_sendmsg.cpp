// SPDX-License-Identifier: MIT
// A bad network for tests: preloaded (LD_PRELOAD) into a process, it loses, doubles and reorders the
// multicast datagrams that the process sends, the same ones in every run with the same seed.
//   MIXLOOP_LOSSY="seed=1,lose=0.05,double=0.02,reorder=0.02"
// A reordered datagram is sent after the next one.
#include <dlfcn.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <mutex>

namespace {

struct Network {
  Network();
  double chance();  // 0 to 1

  double lose = 0, twice = 0, reorder = 0;
  std::uint64_t state = 0;
};

struct Held {
  int fd = -1;
  sockaddr_in to{};
  std::size_t size = 0;
  unsigned char bytes[65536];
};

double entry(const char* name, double otherwise) {
  const char* text = std::getenv("MIXLOOP_LOSSY");
  const char* at = text == nullptr ? nullptr : std::strstr(text, name);
  return at == nullptr ? otherwise : std::atof(at + std::strlen(name));
}

Network::Network()
    : lose(entry("lose=", 0)),
      twice(entry("double=", 0)),
      reorder(entry("reorder=", 0)),
      state(static_cast<std::uint64_t>(entry("seed=", 1))) {}

// splitmix64
double Network::chance() {
  std::uint64_t z = state += 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

std::mutex busy;
Held held;

bool is_multicast(const msghdr* message) {
  const auto* to = static_cast<const sockaddr_in*>(message->msg_name);
  return to != nullptr && message->msg_namelen >= sizeof *to && to->sin_family == AF_INET &&
         IN_MULTICAST(ntohl(to->sin_addr.s_addr));
}

void hold(int fd, const msghdr* message) {
  held.fd = fd;
  held.to = *static_cast<const sockaddr_in*>(message->msg_name);
  held.size = 0;
  for (std::size_t i = 0; i < message->msg_iovlen; ++i) {
    const iovec& part = message->msg_iov[i];
    if (held.size + part.iov_len > sizeof held.bytes) break;
    std::memcpy(held.bytes + held.size, part.iov_base, part.iov_len);
    held.size += part.iov_len;
  }
}

void release() {
  if (held.fd < 0) return;
  sendto(held.fd, held.bytes, held.size, 0, reinterpret_cast<const sockaddr*>(&held.to), sizeof held.to);
  held.fd = -1;
}

}  // namespace

extern "C" ssize_t sendmsg(int fd, const msghdr* message, int flags) {
  using Sendmsg = ssize_t (*)(int, const msghdr*, int);
  static const auto send = reinterpret_cast<Sendmsg>(dlsym(RTLD_NEXT, "sendmsg"));
  static Network network;
  if (!is_multicast(message)) return send(fd, message, flags);

  ssize_t size = 0;
  for (std::size_t i = 0; i < message->msg_iovlen; ++i)
    size += static_cast<ssize_t>(message->msg_iov[i].iov_len);

  const std::lock_guard lock(busy);
  // Always three numbers a datagram: one rate doesn't change what another one hits.
  const bool lost = network.chance() < network.lose;
  const bool doubled = network.chance() < network.twice;
  const bool reordered = network.chance() < network.reorder;
  if (lost) return size;
  if (reordered && held.fd < 0) {
    hold(fd, message);
    return size;
  }
  const ssize_t sent = send(fd, message, flags);
  if (doubled) send(fd, message, flags);
  release();
  return sent;
}
