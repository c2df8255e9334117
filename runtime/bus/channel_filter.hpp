// SPDX-License-Identifier: MIT
#pragma once

#include <linux/filter.h>

#include <span>
#include <string>
#include <vector>

namespace mixloop {

/// A classic BPF program for LCM's receiving socket: it keeps short LCM messages ("LC02") on one of these
/// channels and drops the rest in the kernel.
///
/// Why: every datagram on the group, one's own included, wakes LCM's receiving thread in every process,
/// which costs more than all that a tick computes. And LCM 1.3.1 keeps every channel name that it ever
/// heard, and trusts the offsets in fragments ("LC03"): neither should be open to strangers.
std::vector<sock_filter> channel_filter(std::span<const std::string> channels);

/// The UDP sockets of this process that are bound to a port, as file descriptors, sorted.
std::vector<int> sockets_on_port(int port);

/// Attaches the filter to a socket; whether the kernel took it.
bool attach(int socket, std::span<const sock_filter> program);

}  // namespace mixloop
