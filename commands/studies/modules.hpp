// SPDX-License-Identifier: MIT
#pragma once

#include "sweep/column_file.hpp"
#include "sweep/peers.hpp"

namespace mixloop {

/// What writes tables as HDF5; null where this build, or this machine, has no such part.
WriteColumns hdf5_here();

/// The processes that MPI started this one with; null where it was started alone. Throws
/// RunFault("missing_part") where it was started by MPI and this build, or this machine, has no part for it.
Peers* peers_here();

}  // namespace mixloop
