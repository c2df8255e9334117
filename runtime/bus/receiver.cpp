// SPDX-License-Identifier: MIT
#include "runtime/bus/receiver.hpp"

#include <arpa/inet.h>
#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "notation/errors.hpp"
#include "runtime/bus/big_endian.hpp"
#include "runtime/bus/channel_filter.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kDatagramHeader = 8;  // magic and sequence number
constexpr std::size_t kLongestName = 63;    // LCM_MAX_CHANNEL_NAME_LENGTH
constexpr int kBuffer = 4 << 20;            // bytes that may wait; the kernel gives what rmem_max allows

[[noreturn]] void refuse(int socket, const char* what) {
  const std::string why = std::strerror(errno);
  ::close(socket);
  throw RunFault("bus", std::string("no socket that hears the bus: ") + what + ": " + why);
}

void set(int socket, int level, int option, int value, const char* what) {
  if (setsockopt(socket, level, option, &value, sizeof value) != 0) refuse(socket, what);
}

}  // namespace

Receiver::Receiver(const MulticastGroup& group, std::span<const sock_filter> filter, Times times)
    : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)),
      datagram_(std::make_unique<std::uint8_t[]>(kLargest)) {
  if (socket_ < 0) refuse(socket_, "socket");
  if (!attach(socket_, filter)) refuse(socket_, "SO_ATTACH_FILTER");
  set(socket_, SOL_SOCKET, SO_REUSEADDR, 1, "SO_REUSEADDR");
  // Who may, gets it; who may not, what net.core.rmem_max allows.
  if (setsockopt(socket_, SOL_SOCKET, SO_RCVBUFFORCE, &kBuffer, sizeof kBuffer) != 0)
    set(socket_, SOL_SOCKET, SO_RCVBUF, kBuffer, "SO_RCVBUF");
  if (times == Times::of_receipt) set(socket_, SOL_SOCKET, SO_TIMESTAMP, 1, "SO_TIMESTAMP");
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(group.port));
  ip_mreq membership{};
  if (inet_pton(AF_INET, group.address.c_str(), &address.sin_addr) != 1)
    refuse(socket_, "the group's address");
  membership.imr_multiaddr = address.sin_addr;
  // Bound to the group, not to any address: what is sent to this machine alone, or to another group, is not
  // heard.
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    refuse(socket_, "bind");
  if (setsockopt(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) != 0)
    refuse(socket_, "IP_ADD_MEMBERSHIP");
}

Receiver::~Receiver() { ::close(socket_); }

void Receiver::set_filter(std::span<const sock_filter> filter) {
  if (!attach(socket_, filter)) throw RunFault("bus", "the kernel takes no filter of channels");
}

const Received* Receiver::next() {
  for (;;) {
    iovec place{datagram_.get(), kLargest};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(timeval))> control;
    sockaddr_in sender{};
    msghdr header{};
    header.msg_name = &sender;
    header.msg_namelen = sizeof sender;
    header.msg_iov = &place;
    header.msg_iovlen = 1;
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    const ssize_t size = recvmsg(socket_, &header, MSG_DONTWAIT);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return nullptr;
    if (size < 0) throw RunFault("bus", std::string("reading the bus failed: ") + std::strerror(errno));
    if ((header.msg_flags & MSG_TRUNC) != 0 ||
        !read_short_message({datagram_.get(), static_cast<std::size_t>(size)}, message_)) {
      ++malformed_;
      continue;
    }
    message_.sender = {.address = ntohl(sender.sin_addr.s_addr), .port = ntohs(sender.sin_port)};
    message_.at_us = 0;
    for (const cmsghdr* part = CMSG_FIRSTHDR(&header); part;
         part = CMSG_NXTHDR(&header, const_cast<cmsghdr*>(part)))
      if (part->cmsg_level == SOL_SOCKET && part->cmsg_type == SCM_TIMESTAMP) {
        timeval at;
        std::memcpy(&at, CMSG_DATA(part), sizeof at);
        message_.at_us = at.tv_sec * std::int64_t{1'000'000} + at.tv_usec;
      }
    return &message_;
  }
}

bool read_short_message(Bytes datagram, Received& message) {
  const std::uint8_t* bytes = datagram.data();
  const std::size_t size = datagram.size();
  if (size < kDatagramHeader + 1 || big_endian<std::uint32_t>(bytes) != kShortMessage) return false;
  const std::uint8_t* name = bytes + kDatagramHeader;
  const std::size_t room = std::min(size - kDatagramHeader, kLongestName + 1);
  const auto* end = static_cast<const std::uint8_t*>(std::memchr(name, 0, room));
  if (end == nullptr) return false;
  message.channel = {reinterpret_cast<const char*>(name), static_cast<std::size_t>(end - name)};
  message.data = {end + 1, static_cast<std::size_t>(bytes + size - (end + 1))};
  return true;
}

std::uint64_t Receiver::dropped_by_kernel() const {
  std::array<std::uint32_t, SK_MEMINFO_VARS> info{};
  socklen_t size = sizeof info;
  if (getsockopt(socket_, SOL_SOCKET, SO_MEMINFO, info.data(), &size) != 0) return 0;
  return info[SK_MEMINFO_DROPS];
}

}  // namespace mixloop
