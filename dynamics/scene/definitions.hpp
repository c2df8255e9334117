// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "notation/document.hpp"

namespace mixloop {

/// Calls `define(entry)` for each `name: formula` of a mapping, each after those of the same mapping
/// that it refers to. Throws InputError("cyclic_definition") naming the cycle.
void define_in_order(const Node& mapping, const std::string& what,
                     const std::function<void(const Node::Entry&)>& define);

}  // namespace mixloop
