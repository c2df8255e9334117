// SPDX-License-Identifier: MIT
#include "dynamics/program/explanation.hpp"

#include <fmt/format.h>

#include "dynamics/procedure/procedure.hpp"
#include "dynamics/program/counted.hpp"
#include "dynamics/program/machine_code.hpp"

namespace mixloop {
namespace {

class LiteralCount {
 public:
  explicit LiteralCount(const std::shared_ptr<const Scene>& scene)
      : n_(scene->n()),
        model_(make(scene)),
        workspace_(model_),
        psi_(static_cast<std::size_t>(n_), 0.5),
        other_(psi_) {}

  OperationCount of(Purpose purpose) {
    Counted::count() = {};
    switch (purpose) {
      case Purpose::forward_dynamics:
        forward();
        break;
      case Purpose::mass_times:
        mass_times();
        break;
      case Purpose::mass_matrix:
        mass_matrix<Counted>(model_, psi_, t_, workspace_);
        break;
      case Purpose::bias:
        bias<Counted>(model_, psi_, other_, t_, workspace_);
        break;
      case Purpose::inverse_dynamics:
        inverse_dynamics<Counted>(model_, psi_, other_, other_, t_, workspace_);
        break;
      case Purpose::end_effector:
        end_effector<Counted>(model_, psi_, other_, other_, t_, workspace_);
        break;
      case Purpose::energy:
        energy<Counted>(model_, psi_, other_, t_, workspace_);
        break;
      case Purpose::linearisation:  // as differences would take it: one more evaluation a column
        for (int k = 0; k <= 3 * n_; ++k) forward();
        break;
      case Purpose::dynamics_and_mass_times:
        forward(), mass_times();
        break;
    }
    return Counted::count();
  }

 private:
  static Model<Counted> make(const std::shared_ptr<const Scene>& scene) {
    const std::vector<double> values = scene->default_parameters();
    const std::vector<Counted> parameters(values.begin(), values.end());
    return make_model<Counted>(scene, std::span<const Counted>(parameters));
  }
  void forward() { forward_dynamics<Counted>(model_, psi_, other_, other_, t_, workspace_); }
  void mass_times() {
    const Vec<Counted> a = map_of(std::span<const Counted>(other_));
    workspace_.out.noalias() = mass_matrix<Counted>(model_, psi_, t_, workspace_).lazyProduct(a);
  }

  int n_;
  Model<Counted> model_;
  Workspace<Counted> workspace_;
  std::vector<Counted> psi_, other_;
  Counted t_ = 0.25;
};

}  // namespace

Explanation explain(const std::shared_ptr<const Scene>& scene) {
  Explanation explanation;
  LiteralCount literal(scene);
  for (Purpose purpose : kPurposes) {
    const TracedProgram traced = trace(scene, purpose);
    explanation.quantities.push_back({purpose, literal.of(purpose), traced.program.run_operations(),
                                      traced.program.set_up_operations(), traced.tracing,
                                      is_compiled(traced.program)});
  }
  explanation.reasons = reasons_of(scene);
  for (const auto& quantity : explanation.quantities) {
    if (quantity.purpose == Purpose::forward_dynamics && quantity.tracing == Tracing::articulated)
      explanation.reasons.push_back(
          "Each independent coordinate moves one joint: forward dynamics by articulated bodies, without a "
          "mass matrix.");
    if (!quantity.compiled)
      explanation.reasons.push_back(
          fmt::format("{} takes more than {} operations: interpreted, not compiled.",
                      name_of(quantity.purpose), kMostCompiledOperations));
  }
  return explanation;
}

}  // namespace mixloop
