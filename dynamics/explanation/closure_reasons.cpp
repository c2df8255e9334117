// SPDX-License-Identifier: MIT
// How a scene's closures are solved, in words.
#include <fmt/format.h>

#include "dynamics/explanation/explanation.hpp"
#include "dynamics/program/program.hpp"
#include "dynamics/symbolic/closed_chains.hpp"
#include "notation/utf8.hpp"
#include "notation/words.hpp"

namespace mixloop {
namespace {

std::string names_of(const Scene& scene, const std::vector<int>& coordinates) {
  std::vector<std::string> names;
  for (int j : coordinates) names.push_back(scene.coordinates[static_cast<std::size_t>(j)].name);
  return joined(names);
}

std::string closures_of(const Scene& scene, const std::vector<Scene::ClosureRow>& rows) {
  std::vector<std::string> names;
  for (const auto& row : rows) {
    const std::string name = in_quotes(scene.closures[static_cast<std::size_t>(row.closure)].name);
    if (names.empty() || names.back() != name) names.push_back(name);
  }
  return joined(names);
}

std::string words_for(const Scene& scene, const Scene::Block& block, BlockSolution how) {
  switch (how) {
    case BlockSolution::single:
      return "in closed form, one coordinate by one row";
    case BlockSolution::dyad:
      return "in closed form, as two links between two known points";
    case BlockSolution::distances:
      return "in closed form, as a point at three distances";
    case BlockSolution::torn:
      return fmt::format(
          "torn: {} cut out, by {} corrections of Newton's method from the last accepted pose, the "
          "others in closed form, as links that turn alone",
          names_of(scene, block.cut), ClosedChains::kCorrectionsOfCut);
    case BlockSolution::newton:
      break;
  }
  return fmt::format("by {} corrections of Newton's method from the last accepted pose",
                     ClosedChains::kCorrections);
}

}  // namespace

std::vector<std::string> closure_reasons(const std::shared_ptr<const Scene>& scene) {
  std::vector<std::string> say;
  if (scene->closures.empty()) return say;
  if (!scene->linear.empty())
    say.push_back(
        fmt::format("From the closures {} follow linearly for all poses: they have constants in place "
                    "of closures.",
                    names_of(*scene, scene->linear)));
  if (!scene->redundant_rows.empty())
    say.push_back(fmt::format("{} rows of {} follow from the others: not solved, but watched.",
                              scene->redundant_rows.size(), closures_of(*scene, scene->redundant_rows)));
  if (!scene->is_closed()) return say;
  Graph graph;
  const Recording recording(graph);
  const ClosedCoordinates closed(scene);
  std::size_t before = 0;
  std::vector<NodeId> nodes;
  for (std::size_t b = 0; b < scene->blocks.size(); ++b) {
    const auto& block = scene->blocks[b];
    for (int j : block.unknowns) {
      const Expression& x = closed.x(j);
      if (!scene->turns(j)) {
        nodes.push_back(x.node());
        continue;
      }
      nodes.push_back(cos(x).node());
      nodes.push_back(sin(x).node());
    }
    const OperationCount count = make_program(graph, nodes).run_operations();
    say.push_back(fmt::format("{} of {} are solved {}: {} operations.", names_of(*scene, block.unknowns),
                              closures_of(*scene, block.rows),
                              words_for(*scene, block, closed.solutions()[b]), count.flops() - before));
    before = count.flops();
  }
  return say;
}

}  // namespace mixloop
