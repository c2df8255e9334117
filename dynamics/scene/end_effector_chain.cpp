// SPDX-License-Identifier: MIT
#include "dynamics/scene/end_effector_chain.hpp"

#include "dynamics/scene/screws.hpp"

namespace mixloop {

namespace {

/// Whether `next` goes on with the screw about z that `last` ends with, or ends it with one about x.
bool is_of_one(const Scene::Transform& last, const Scene::Transform& next) {
  const bool goes_on = last.a.is_zero() && last.alpha.is_zero() && !(last.coordinate && next.coordinate);
  return goes_on || (next.theta.is_zero() && next.s.is_zero());
}

void append(Scene::Transform& last, const Scene::Transform& next) {
  for (const auto part :
       {&Scene::Transform::theta, &Scene::Transform::s, &Scene::Transform::a, &Scene::Transform::alpha})
    last.*part = sum_of(last.*part, next.*part);
  if (next.coordinate) last.coordinate = next.coordinate, last.prismatic = next.prismatic;
}

}  // namespace

std::shared_ptr<const Scene> with_shortest_chain(std::shared_ptr<const Scene> scene) {
  std::vector<const Scene::Transform*> outwards;
  for (int frame = scene->end_effector.frame; frame != 0; frame = outwards.front()->parent)
    outwards.insert(outwards.begin(), &scene->transforms[static_cast<std::size_t>(frame - 1)]);
  std::vector<Scene::Transform> chain;
  for (const auto* next : outwards) {
    if (!chain.empty() && is_of_one(chain.back(), *next))
      append(chain.back(), *next);
    else
      chain.push_back(*next);
  }
  if (chain.size() == outwards.size()) return scene;
  auto shortened = std::make_shared<Scene>(*scene);
  for (std::size_t i = 0; i < chain.size(); ++i) {
    chain[i].parent = i == 0 ? 0 : static_cast<int>(shortened->transforms.size());
    shortened->transforms.push_back(std::move(chain[i]));
    shortened->frames.emplace_back();
  }
  shortened->end_effector.frame = static_cast<int>(shortened->transforms.size());
  return shortened;
}

}  // namespace mixloop
