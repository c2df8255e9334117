// SPDX-License-Identifier: MIT
// The procedure recorded as it stands.
#include "dynamics/procedure/procedure.hpp"
#include "dynamics/scene/end_effector_chain.hpp"
#include "dynamics/symbolic/closed_chains.hpp"
#include "dynamics/symbolic/tracer.hpp"

namespace mixloop {

template class SmallSystem<Expression>;
template struct Workspace<Expression>;
template class detail::CoordinatesAlong<Expression>;
template Model<Expression> make_model(const std::shared_ptr<const Scene>&, std::span<const Expression>);
template void coordinates(const Model<Expression>&, std::span<const Expression>, const Expression&,
                          Workspace<Expression>&);

namespace {

class LiteralTracer final : public Tracer {
 public:
  explicit LiteralTracer(std::shared_ptr<const Scene> scene)
      : in_(*scene),
        model_(make_model<Expression>(scene, std::span<const Expression>(in_.parameters))),
        workspace_(model_) {
    workspace_.solve = [this](const auto&, auto, const auto&, auto& ws) { chains_.solve(model_, ws); };
  }

  ExpressionMatrix mass_matrix() override {
    return mixloop::mass_matrix<Expression>(model_, span_of(in_.psi), in_.t, workspace_);
  }
  ExpressionVector bias() override {
    return mixloop::bias<Expression>(model_, span_of(in_.psi), span_of(in_.psid), in_.t, workspace_);
  }
  Energy<Expression> energy() override {
    return mixloop::energy<Expression>(model_, span_of(in_.psi), span_of(in_.psid), in_.t, workspace_);
  }
  ExpressionVector slopes(int coordinate) override {
    coordinates<Expression>(model_, span_of(in_.psi), in_.t, workspace_);
    return workspace_.C.row(coordinate).transpose();
  }
  std::vector<Cut> cuts() const override { return chains_.cuts(workspace_); }
  std::vector<Expression> solved_from_start() const override {
    return chains_.solved_from_start(model_, workspace_);
  }
  EndEffectorState<Expression> end_effector(const ExpressionVector& psidd) {
    return mixloop::end_effector<Expression>(model_, span_of(in_.psi), span_of(in_.psid), span_of(psidd),
                                             in_.t, workspace_);
  }

 private:
  TracedInputs in_;
  Model<Expression> model_;
  Workspace<Expression> workspace_;
  ClosedChains chains_{in_};
};

}  // namespace

std::unique_ptr<Tracer> literal_tracer(std::shared_ptr<const Scene> scene) {
  return std::make_unique<LiteralTracer>(std::move(scene));
}

EndEffectorState<Expression> trace_end_effector(std::shared_ptr<const Scene> scene,
                                                const ExpressionVector& psidd,
                                                std::vector<Expression>& solved) {
  // Closures may need frames that the end effector does not.
  LiteralTracer tracer(scene->is_closed() ? scene : with_shortest_chain(scene));
  auto state = tracer.end_effector(psidd);
  solved = tracer.solved_from_start();
  return state;
}

}  // namespace mixloop
