// SPDX-License-Identifier: MIT
#pragma once

namespace mixloop {

/// Bytes that this process may still take: what the machine has free (its caches counted), within the limits
/// of its control group and its own.
double free_memory();

}  // namespace mixloop
