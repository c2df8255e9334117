// SPDX-License-Identifier: MIT
#include "dynamics/assembly/partitions.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "dynamics/assembly/assemble.hpp"
#include "dynamics/assembly/structure.hpp"
#include "dynamics/scene/canonical.hpp"
#include "notation/errors.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kMostPartitions = 32;
constexpr int kPosesAbout = 3;
constexpr double kMoves = 1e-6;  // of a rate by another coordinate, rad or of the size

/// What an assembled scene was before, its unknowns' guesses where they are; what was found to be linear
/// stays a formula, which holds whatever is independent.
Scene unassembled(const Scene& assembled) {
  Scene scene = assembled;
  scene.blocks.clear();
  scene.steps.clear();
  scene.started.clear();
  scene.redundant_rows.clear();
  scene.from_starts = true;
  return scene;
}

Formula symbol_alone(int number, const Formula& said) {
  Formula formula{.dimension = said.dimension, .place = said.place};
  formula.nodes.push_back({.op = Formula::Operator::symbol, .symbol = number});
  return formula;
}

/// Calls `change` with each formula in which a coordinate may stand.
template <class Change>
void each_formula(Scene& scene, const Change& change) {
  for (auto& coordinate : scene.coordinates) change(coordinate.constraint);
  for (auto& closure : scene.closures) change(closure.value);
  for (auto& transform : scene.transforms) change(transform.theta), change(transform.s);
  for (auto& load : scene.loads)
    for (auto* vector : {&load.force, &load.moment})
      for (Formula& part : *vector) change(part);
  for (auto& load : scene.along_loads) change(load.along);
  for (auto& singularity : scene.singularities) change(singularity.measure);
}

void refer_to(Scene& scene, int from, int to) {
  each_formula(scene, [&](Formula& formula) {
    for (auto& node : formula.nodes)
      if (node.op == Formula::Operator::symbol && node.symbol == from) node.symbol = to;
  });
}

/// The coordinate that is psi_i and nothing else, in the place of which it is solved; a new one where there
/// is none.
int coordinate_of(Scene& scene, int i) {
  const int psi = Symbols(scene).psi0 + i;
  for (int j = 0; j < scene.m(); ++j) {
    const auto& nodes = scene.coordinates[static_cast<std::size_t>(j)].constraint.nodes;
    if (nodes.size() == 1 && nodes[0].op == Formula::Operator::symbol && nodes[0].symbol == psi) return j;
  }
  const auto& independent = scene.independent[static_cast<std::size_t>(i)];
  scene.coordinates.push_back(
      {.name = independent.name,
       .constraint = symbol_alone(psi, {.dimension = independent.linear ? kLength : kPure}),
       .place = scene.closures.front().place});
  return scene.m() - 1;
}

/// psi_i is solved for, and the unknown q_j independent in its place; home is where all coordinates are.
Partition exchanged(const Scene& declared, int i, int j, const Vector& psi, const std::vector<double>& q) {
  Scene scene = unassembled(declared);
  for (std::size_t k = 0; k < q.size(); ++k) scene.coordinates[k].home = q[k];
  scene.home.assign(psi.begin(), psi.end());
  const auto slot = static_cast<std::size_t>(i);
  Partition partition{.swapped = i, .freed = j, .solved = coordinate_of(scene, i)};
  auto &solved = scene.coordinates[static_cast<std::size_t>(partition.solved)],
       &freed = scene.coordinates[static_cast<std::size_t>(j)];
  const int psi_i = Symbols(scene).psi0 + i;
  solved.constraint.nodes.clear();
  std::erase(scene.evaluation_order, partition.solved);
  refer_to(scene, psi_i, Symbols(scene).q0 + partition.solved);
  solved.home = psi[i];
  freed.constraint = symbol_alone(psi_i, freed.constraint);
  scene.evaluation_order.insert(scene.evaluation_order.begin(), j);
  scene.home[slot] = freed.home;
  if (scene.independent[slot].driven) {
    scene.acts_along.assign(static_cast<std::size_t>(scene.n_u()), -1);
    scene.acts_along[slot] = partition.solved;
  }
  scene.independent[slot].name = freed.name;
  scene.independent[slot].linear = !declared.turns(j);
  assemble(scene);
  scene.canonical = canonical_text(scene);
  partition.scene = std::make_shared<const Scene>(std::move(scene));
  return partition;
}

Partition as_declared(const Scene& declared) {
  Scene scene = unassembled(declared);
  assemble(scene);
  scene.canonical = canonical_text(scene);
  return {.scene = std::make_shared<const Scene>(std::move(scene))};
}

std::shared_ptr<const Scene> showing(const Partition& partition) {
  if (partition.swapped < 0) return partition.scene;
  Scene scene = *partition.scene;
  const int j = partition.solved;
  Formula value = scene.coordinates[static_cast<std::size_t>(j)].constraint;
  value.dimension = kLength;
  const Formula none = constant_formula(0, kLength), straight = constant_formula(0);
  scene.transforms.push_back({.theta = straight,
                              .s = symbol_alone(Symbols(scene).q0 + j, value),
                              .a = none,
                              .alpha = straight,
                              .coordinate = j,
                              .prismatic = true,
                              .place = value.place});
  scene.frames.emplace_back();
  scene.end_effector = {.frame = static_cast<int>(scene.transforms.size()), .point = {none, none, none}};
  scene.canonical = canonical_text(scene);
  return std::make_shared<const Scene>(std::move(scene));
}

}  // namespace

std::vector<Partition> showing_swapped(std::vector<Partition> partitions) {
  for (Partition& partition : partitions) partition.scene = showing(partition);
  return partitions;
}

std::vector<Partition> partitions_of(const Scene& declared) {
  std::vector<Partition> found{as_declared(declared)};
  Closing closing(declared, declared.default_parameters());
  std::vector<ClosedPose> poses{{closing.home(), closing.home_psi()}};
  for (auto& pose : poses_about(closing, closing.home(), kPosesAbout)) poses.push_back(std::move(pose));
  const auto moves = [&](int j, int i) {
    const double unit = (declared.turns(j) ? 1 : declared.size) /
                        (declared.independent[static_cast<std::size_t>(i)].linear ? declared.size : 1);
    return std::ranges::any_of(poses, [&](const ClosedPose& pose) {
      return std::abs(closing.rates(pose.x, pose.psi)(j, i)) > kMoves * unit;
    });
  };
  const auto add = [&](int i, int j) {
    for (const ClosedPose& pose : poses) {
      try {
        found.push_back(exchanged(declared, i, j, pose.psi, closing.coordinates(pose.x, pose.psi)));
        return;
      } catch (const InputError&) {  // singular there in these coordinates; another pose may not be
      }
    }
  };
  for (const auto& block : declared.blocks)
    for (int j : block.unknowns)
      for (int i = 0; i < declared.n(); ++i)
        if (moves(j, i)) add(i, j);
  if (found.size() > kMostPartitions)
    throw InputError(
        "too_large", declared.closures.front().place,
        fmt::format("the closures leave {} choices of independent coordinates to switch to, a program each; "
                    "expected {} at most",
                    found.size() - 1, kMostPartitions - 1));
  return found;
}

}  // namespace mixloop
