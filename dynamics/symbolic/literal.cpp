// SPDX-License-Identifier: MIT
// The procedure recorded as it stands.
#include "dynamics/procedure/procedure.hpp"
#include "dynamics/scene/screws.hpp"
#include "dynamics/symbolic/tracer.hpp"

namespace mixloop {
namespace {

class LiteralTracer final : public Tracer {
 public:
  explicit LiteralTracer(std::shared_ptr<const Scene> scene)
      : in_(*scene),
        model_(make_model<Expression>(scene, std::span<const Expression>(in_.parameters))),
        workspace_(model_) {}

  ExpressionMatrix mass_matrix() override {
    return mixloop::mass_matrix<Expression>(model_, span_of(in_.psi), in_.t, workspace_);
  }
  ExpressionVector bias() override {
    return mixloop::bias<Expression>(model_, span_of(in_.psi), span_of(in_.psid), in_.t, workspace_);
  }
  Energy<Expression> energy() override {
    return mixloop::energy<Expression>(model_, span_of(in_.psi), span_of(in_.psid), in_.t, workspace_);
  }
  EndEffectorState<Expression> end_effector(const ExpressionVector& psidd) {
    return mixloop::end_effector<Expression>(model_, span_of(in_.psi), span_of(in_.psid), span_of(psidd),
                                             in_.t, workspace_);
  }

 private:
  TracedInputs in_;
  Model<Expression> model_;
  Workspace<Expression> workspace_;
};

// The scene's transforms from the ground to the end effector and nothing else. Those in a row that are one
// transform become one, so that the program is the same however the chain is told.
std::shared_ptr<const Scene> chain_alone(const Scene& scene) {
  std::vector<Scene::Transform> row;
  for (int frame = scene.end_effector.frame; frame != 0;) {
    row.push_back(scene.transforms[static_cast<std::size_t>(frame - 1)]);
    frame = row.back().parent;
  }
  std::vector<Scene::Transform> chain;
  for (auto next = row.rbegin(); next != row.rend(); ++next) {
    const bool goes_on = !chain.empty() && chain.back().a.is_zero() && chain.back().alpha.is_zero() &&
                         !(chain.back().coordinate && next->coordinate);
    const bool ends = !chain.empty() && next->theta.is_zero() && next->s.is_zero();
    if (!goes_on && !ends) {
      chain.push_back(*next);
      continue;
    }
    Scene::Transform& last = chain.back();
    for (const auto part :
         {&Scene::Transform::theta, &Scene::Transform::s, &Scene::Transform::a, &Scene::Transform::alpha})
      last.*part = sum_of(last.*part, (*next).*part);
    if (next->coordinate) last.coordinate = next->coordinate, last.prismatic = next->prismatic;
  }
  auto alone = std::make_shared<Scene>(scene);
  alone->bodies.clear(), alone->loads.clear(), alone->coordinate_loads.clear();
  alone->along_loads.clear(), alone->between_loads.clear();
  for (std::size_t i = 0; i < chain.size(); ++i) chain[i].parent = static_cast<int>(i);
  alone->end_effector.frame = static_cast<int>(chain.size());
  alone->frames.assign(chain.size() + 1, "");
  alone->transforms = std::move(chain);
  return alone;
}

}  // namespace

std::unique_ptr<Tracer> literal_tracer(std::shared_ptr<const Scene> scene) {
  return std::make_unique<LiteralTracer>(std::move(scene));
}

EndEffectorState<Expression> trace_end_effector(std::shared_ptr<const Scene> scene,
                                                const ExpressionVector& psidd) {
  return LiteralTracer(chain_alone(*scene)).end_effector(psidd);
}

}  // namespace mixloop
