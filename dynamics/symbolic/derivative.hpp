// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "dynamics/symbolic/graph.hpp"

namespace mixloop {

/// Exact forward derivatives: result[k] = sum_i d outputs[k] / d inputs[i] * seeds[i].
std::vector<NodeId> tangents(Graph& graph, std::span<const NodeId> outputs, std::span<const NodeId> inputs,
                             std::span<const NodeId> seeds);

/// Exact reverse derivatives: result[i] = d output / d inputs[i]. Inputs may be inner nodes: each is varied
/// alone, whatever it is made of.
std::vector<NodeId> gradient(Graph& graph, NodeId output, std::span<const NodeId> inputs);

/// The outputs with each inputs[i] replaced by replacements[i].
std::vector<NodeId> substituted(Graph& graph, std::span<const NodeId> outputs, std::span<const NodeId> inputs,
                                std::span<const NodeId> replacements);

}  // namespace mixloop
