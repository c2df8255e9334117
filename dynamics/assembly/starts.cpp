// SPDX-License-Identifier: MIT
#include "dynamics/assembly/starts.hpp"

#include <algorithm>
#include <memory>
#include <set>

#include "dynamics/program/program.hpp"
#include "dynamics/symbolic/closed_chains.hpp"
#include "dynamics/symbolic/tracer.hpp"

namespace mixloop {
namespace {

/// The indices of the starts that motion and energy depend on, every unknown having one.
std::set<NodeId> starts_that_count(const std::shared_ptr<const Scene>& scene) {
  Graph graph;
  const Recording recording(graph);
  const auto tracer = recursive_tracer(scene);
  const Energy<Expression> energy = tracer->energy();
  std::vector<NodeId> outputs{energy.kinetic.node(), energy.potential.node()};
  for (const Expression& force : tracer->bias()) outputs.push_back(force.node());
  std::set<NodeId> found;
  for (const ExpressionNode& node : make_program(graph, outputs).nodes)
    if (node.op == Op::input && static_cast<Block>(node.a) == Block::start) found.insert(node.b);
  return found;
}

}  // namespace

void find_starts(Scene& scene) {
  if (!scene.is_closed()) return;
  auto all = std::make_shared<Scene>(scene);
  for (const auto& block : scene.blocks)
    all->started.insert(all->started.end(), block.unknowns.begin(), block.unknowns.end());
  {
    Graph graph;
    const Recording recording(graph);
    ClosedCoordinates closed(all);
    for (std::size_t b = 0; b < scene.blocks.size(); ++b) {
      scene.blocks[b].by_newton = closed.solutions()[b] == BlockSolution::newton;
      if (scene.blocks[b].by_newton && !scene.from_starts)
        scene.blocks[b].cut = closed.cut(static_cast<int>(b));
    }
  }
  all->blocks = scene.blocks;
  const std::set<NodeId> counting = starts_that_count(all);
  NodeId index = 0;
  for (const auto& block : scene.blocks)
    for (int j : block.unknowns) {
      const auto corrected = block.corrected();
      bool needed = std::find(corrected.begin(), corrected.end(), j) != corrected.end();
      for (int k = scene.turns(j) ? 3 : 1; k > 0; --k) needed = counting.contains(index++) || needed;
      if (needed) scene.started.push_back(j);
    }
}

}  // namespace mixloop
