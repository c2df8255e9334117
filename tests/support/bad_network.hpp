// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace mixloop {

/// The environment of a command whose datagrams get lost, doubled and out of order, by this seed.
inline std::vector<std::string> bad_network(int seed) {
  return {"LD_PRELOAD=" MIXLOOP_LOSSY_LIBRARY, "ASAN_OPTIONS=verify_asan_link_order=0",
          "MIXLOOP_LOSSY=seed=" + std::to_string(seed) + ",lose=0.05,double=0.02,reorder=0.02"};
}

}  // namespace mixloop
