// SPDX-License-Identifier: MIT
// The procedure recorded as it stands.
#include "dynamics/procedure/procedure.hpp"
#include "dynamics/scene/end_effector_chain.hpp"
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

}  // namespace

std::unique_ptr<Tracer> literal_tracer(std::shared_ptr<const Scene> scene) {
  return std::make_unique<LiteralTracer>(std::move(scene));
}

EndEffectorState<Expression> trace_end_effector(std::shared_ptr<const Scene> scene,
                                                const ExpressionVector& psidd) {
  return LiteralTracer(with_shortest_chain(std::move(scene))).end_effector(psidd);
}

}  // namespace mixloop
