// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/program/program.hpp"

namespace mixloop {

/// The same program with its sums and products taken in another order, in as many operations: what is known
/// first is added first, and a sum takes a product that is known last in (Op::fma and its like). A scheme
/// such as Horner's leaves long chains in which each operation waits for the one before; a processor does
/// several at once.
Program with_short_chains(const Program& program);

}  // namespace mixloop
