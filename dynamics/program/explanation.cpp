// SPDX-License-Identifier: MIT
#include "dynamics/program/explanation.hpp"

#include <fmt/format.h>

#include "dynamics/procedure/outputs.hpp"
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
        other_(static_cast<std::size_t>(2 * n_), 0.5) {}

  OperationCount of(Purpose purpose) {
    Counted::count() = {};
    if (purpose != Purpose::linearisation) {
      evaluate(purpose);
    } else {  // as differences would take it: one more evaluation a column
      for (int k = 0; k <= 3 * n_; ++k) evaluate(Purpose::forward_dynamics);
    }
    return Counted::count();
  }

 private:
  static Model<Counted> make(const std::shared_ptr<const Scene>& scene) {
    const std::vector<double> values = scene->default_parameters();
    const std::vector<Counted> parameters(values.begin(), values.end());
    return make_model<Counted>(scene, std::span<const Counted>(parameters));
  }
  void evaluate(Purpose purpose) {
    std::vector<Counted> out(output_size(purpose, n_, model_.n_u()));
    put_outputs<Counted>(purpose, model_, psi_, other_, other_, t_, workspace_, out.data());
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
