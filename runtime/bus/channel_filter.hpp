// SPDX-License-Identifier: MIT
#pragma once

#include <linux/filter.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mixloop {

/// What a short LCM message begins with: "LC02", highest byte first.
inline constexpr std::uint32_t kShortMessage = 0x4c433032;

/// A classic BPF program for a receiving socket: it keeps short LCM messages ("LC02") on one of these
/// channels and drops the rest in the kernel.
///
/// Why: every datagram on the group, one's own included, would wake every process, which costs more than all
/// that a tick computes.
std::vector<sock_filter> channel_filter(std::span<const std::string> channels);

/// The same for all channels: short messages, whatever their names.
std::vector<sock_filter> short_message_filter();

/// Attaches the filter to a socket; whether the kernel took it.
bool attach(int socket, std::span<const sock_filter> program);

}  // namespace mixloop
