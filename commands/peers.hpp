// SPDX-License-Identifier: MIT
#pragma once

#include "sweep/peers.hpp"

namespace mixloop {

/// The processes that MPI started this one with; null where it was started alone. Throws
/// RunFault("missing_part") where it was started by MPI and this build, or this machine, has none.
Peers* peers_here();

}  // namespace mixloop
