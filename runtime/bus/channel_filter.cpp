// SPDX-License-Identifier: MIT
#include "runtime/bus/channel_filter.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace mixloop {
namespace {

constexpr std::uint32_t kUdpHeader = 8;  // the program sees the packet from its UDP header on
constexpr std::uint32_t kLcmHeader = 8;  // magic and sequence number
constexpr std::uint32_t kKeepAll = 0xffffffff, kDrop = 0;

constexpr std::uint16_t load(std::size_t width) {
  return static_cast<std::uint16_t>(BPF_LD | BPF_ABS | (width == 4 ? BPF_W : width == 2 ? BPF_H : BPF_B));
}

// The channel's name with its terminator stands at `kUdpHeader + kLcmHeader`; compared four bytes at a time,
// then two, then one. Every comparison that fails jumps behind this name's part of the program.
void append_channel(std::vector<sock_filter>& program, std::string_view name) {
  const std::size_t length = name.size() + 1;
  const std::size_t comparisons = length / 4 + length % 4 / 2 + length % 2;
  std::size_t left = comparisons;
  for (std::size_t at = 0; at < length;) {
    const std::size_t width = length - at >= 4 ? 4 : length - at >= 2 ? 2 : 1;
    std::uint32_t expected = 0;
    for (std::size_t i = at; i < at + width; ++i)
      expected = expected << 8 | (i < name.size() ? static_cast<std::uint8_t>(name[i]) : 0U);
    --left;
    program.push_back(BPF_STMT(load(width), static_cast<std::uint32_t>(kUdpHeader + kLcmHeader + at)));
    program.push_back(
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, expected, 0, static_cast<std::uint8_t>(2 * left + 1)));
    at += width;
  }
  program.push_back(BPF_STMT(BPF_RET | BPF_K, kKeepAll));
}

}  // namespace

std::vector<sock_filter> channel_filter(std::span<const std::string> channels) {
  std::vector<sock_filter> program{
      BPF_STMT(BPF_LD | BPF_ABS | BPF_W, kUdpHeader),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kShortMessage, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, kDrop),
  };
  // Shorter names first: a load past the packet's end drops it, and a message with no data on a short
  // channel must have matched before that.
  std::vector<std::string> by_length(channels.begin(), channels.end());
  std::stable_sort(by_length.begin(), by_length.end(),
                   [](const auto& a, const auto& b) { return a.size() < b.size(); });
  for (const std::string& channel : by_length) append_channel(program, channel);
  program.push_back(BPF_STMT(BPF_RET | BPF_K, kDrop));
  return program;
}

std::vector<sock_filter> short_message_filter() {
  return {
      BPF_STMT(BPF_LD | BPF_ABS | BPF_W, kUdpHeader),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kShortMessage, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, kDrop),
      BPF_STMT(BPF_RET | BPF_K, kKeepAll),
  };
}

bool attach(int socket, std::span<const sock_filter> program) {
  sock_fprog filter{.len = static_cast<unsigned short>(program.size()),
                    .filter = const_cast<sock_filter*>(program.data())};
  return setsockopt(socket, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter) == 0;
}

}  // namespace mixloop
