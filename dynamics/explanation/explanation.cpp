// SPDX-License-Identifier: MIT
#include "dynamics/explanation/explanation.hpp"

#include <fmt/format.h>

#include <optional>

#include "dynamics/explanation/counted.hpp"
#include "dynamics/procedure/outputs.hpp"
#include "dynamics/program/machine_code.hpp"
#include "notation/long_work.hpp"

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
    work_goes_on();
    Counted::count() = {};
    if (purpose != Purpose::linearisation) {
      evaluate(purpose);
      return Counted::count();
    }
    evaluate(Purpose::forward_dynamics);  // as differences would take it: one more evaluation a column
    return Counted::count().times(static_cast<std::size_t>(3 * n_) + 1);
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

std::optional<Evaluation> evaluation_of(Purpose purpose, const Program& program, bool has_compiler) {
  if (!program.outputs.empty())
    return has_compiler && is_compiled(program) ? Evaluation::machine_code : Evaluation::interpreter;
  return purpose == Purpose::linearisation ? std::nullopt : std::optional(Evaluation::reference);
}

std::optional<std::string> why_not_compiled(const Explanation::Quantity& quantity, const Program& program) {
  const auto says = [&](std::size_t operations, const char* what) {
    return fmt::format("{} takes more than {} operations: {}.", name_of(quantity.purpose), operations, what);
  };
  if (!quantity.evaluation)
    return says(kMostOfDerivatives, "there is none, for stability and implicit integrators");
  if (quantity.evaluation == Evaluation::reference)
    return says(Graph::kMostNodes, "evaluated as the equations are written");
  if (is_compiled(program)) return std::nullopt;
  return says(kMostCompiledOperations, "interpreted, not compiled");
}

}  // namespace

Explanation explain(const std::shared_ptr<const Scene>& scene) {
  Explanation explanation;
  LiteralCount literal(scene);
  const std::string hindrance = MachineCode::hindrance();
  std::vector<std::string> of_length;
  for (Purpose purpose : kPurposes) {
    if (output_size(purpose, scene->n(), scene->n_u()) == 0) continue;  // M a of a scene without motors
    const TracedProgram traced = trace(scene, purpose);
    const OperationCount as_written = literal.of(purpose);
    const auto& quantity = explanation.quantities.emplace_back(Explanation::Quantity{
        purpose, as_written, traced.program.outputs.empty() ? as_written : traced.program.run_operations(),
        traced.program.set_up_operations(), traced.tracing,
        evaluation_of(purpose, traced.program, hindrance.empty())});
    if (purpose == Purpose::forward_dynamics && traced.tracing == Tracing::articulated)
      of_length.push_back(
          "Each independent coordinate moves one joint: forward dynamics by articulated bodies, without a "
          "mass matrix.");
    if (const auto why = why_not_compiled(quantity, traced.program)) of_length.push_back(*why);
  }
  explanation.reasons = reasons_of(scene);
  explanation.reasons.insert(explanation.reasons.end(), of_length.begin(), of_length.end());
  if (!hindrance.empty())
    explanation.reasons.push_back("Here all programs are interpreted: " + hindrance + ".");
  return explanation;
}

}  // namespace mixloop
