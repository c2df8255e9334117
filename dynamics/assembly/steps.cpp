// SPDX-License-Identifier: MIT
#include "dynamics/assembly/steps.hpp"

#include <algorithm>

namespace mixloop {
namespace {

/// What coordinates need each other for.
class Needs {
 public:
  explicit Needs(const Scene& scene) : scene_(scene), symbols_(scene) {}

  std::vector<bool> of_formula(const Formula& formula) const {
    std::vector<bool> needed(scene_.coordinates.size(), false);
    for (const auto& node : formula.nodes)
      if (node.op == Formula::Operator::symbol && symbols_.is_q(node.symbol))
        needed[static_cast<std::size_t>(node.symbol - symbols_.q0)] = true;
    return needed;
  }

  std::vector<bool> of_closure(const Scene::Closure& closure) const {
    std::vector<bool> needed = of_formula(closure.value);
    if (closure.kind == Scene::Closure::Kind::zero) return needed;
    for (int frame : {closure.frames[0], closure.frames[1], std::max(closure.in, 0)})
      for (; frame > 0; frame = scene_.transforms[static_cast<std::size_t>(frame - 1)].parent) {
        const auto& coordinate = scene_.transforms[static_cast<std::size_t>(frame - 1)].coordinate;
        if (coordinate) needed[static_cast<std::size_t>(*coordinate)] = true;
      }
    return needed;
  }

  /// The coordinates with a formula that rows need and that themselves need one of `unknowns`, in order.
  std::vector<int> between(const std::vector<int>& unknowns,
                           const std::vector<Scene::ClosureRow>& rows) const {
    std::vector<bool> moved(scene_.coordinates.size(), false), wanted = moved;
    for (int j : unknowns) moved[static_cast<std::size_t>(j)] = true;
    for (int j : scene_.evaluation_order) {
      const auto needs = of_formula(scene_.coordinates[static_cast<std::size_t>(j)].constraint);
      for (std::size_t k = 0; k < needs.size(); ++k)
        if (needs[k] && moved[k]) moved[static_cast<std::size_t>(j)] = true;
    }
    for (const auto& row : rows) {
      const auto needs = of_closure(scene_.closures[static_cast<std::size_t>(row.closure)]);
      for (std::size_t k = 0; k < needs.size(); ++k)
        if (needs[k]) wanted[k] = true;
    }
    std::vector<int> between;
    for (auto j = scene_.evaluation_order.rbegin(); j != scene_.evaluation_order.rend(); ++j) {
      if (!wanted[static_cast<std::size_t>(*j)]) continue;
      const auto needs = of_formula(scene_.coordinates[static_cast<std::size_t>(*j)].constraint);
      for (std::size_t k = 0; k < needs.size(); ++k)
        if (needs[k]) wanted[k] = true;
      if (moved[static_cast<std::size_t>(*j)]) between.insert(between.begin(), *j);
    }
    return between;
  }

 private:
  const Scene& scene_;
  const Symbols symbols_;
};

}  // namespace

void put_steps(Scene& scene, const Closing& closing, const std::vector<Closing::Part>& blocks,
               const std::vector<bool>& is_linear) {
  const Needs needs(scene);
  std::vector<bool> known(scene.coordinates.size(), false);
  scene.steps.clear();
  const auto add_formulas = [&] {
    for (int j : scene.evaluation_order) {
      if (known[static_cast<std::size_t>(j)]) continue;
      const auto needed = needs.of_formula(scene.coordinates[static_cast<std::size_t>(j)].constraint);
      bool ready = true;
      for (std::size_t k = 0; k < needed.size(); ++k) ready = ready && (!needed[k] || known[k]);
      if (!ready) continue;
      known[static_cast<std::size_t>(j)] = true;
      scene.steps.push_back({.coordinate = j});
    }
  };
  add_formulas();
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (is_linear[b]) continue;
    Scene::Block block;
    for (int u : blocks[b].unknowns) block.unknowns.push_back(closing.coordinate(u));
    for (int r : blocks[b].rows) block.rows.push_back(closing.row(r));
    block.within = needs.between(block.unknowns, block.rows);
    for (int j : block.unknowns) known[static_cast<std::size_t>(j)] = true;
    for (int j : block.within) known[static_cast<std::size_t>(j)] = true;
    scene.steps.push_back({.block = static_cast<int>(scene.blocks.size())});
    scene.blocks.push_back(std::move(block));
    add_formulas();
  }
}

}  // namespace mixloop
