// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mixloop {

/// Where an LCM url of the form udpm://ADDRESS:PORT?... sends to.
struct MulticastGroup {
  std::string address;
  int port = 0;
};

/// Reads the url. Throws RunFault `bus_url`, saying what was found and expected.
MulticastGroup multicast_group(const std::string& url);

/// Throws RunFault `no_multicast_route` where this machine (or namespace) can't send to the group: what was
/// found, and the commands that mend it.
void require_multicast_route(const MulticastGroup& group);

}  // namespace mixloop
