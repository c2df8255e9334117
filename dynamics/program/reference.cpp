// SPDX-License-Identifier: MIT
#include "dynamics/program/reference.hpp"

#include <fmt/format.h>

#include "dynamics/procedure/outputs.hpp"
#include "dynamics/program/interpreter.hpp"
#include "dynamics/program/trace.hpp"
#include "notation/errors.hpp"

namespace mixloop {
namespace {

struct Procedure {
  Model<double> model;
  Workspace<double> workspace;
};

class Reference final : public Routine {
 public:
  Reference(std::shared_ptr<const Scene> scene, Purpose purpose)
      : scene_(std::move(scene)), purpose_(purpose) {}

  Memory make_memory() const override {
    auto model = make_model<double>(scene_, std::span<const double>(scene_->default_parameters()));
    Workspace<double> workspace(model);
    return {{}, Procedure{std::move(model), std::move(workspace)}};
  }
  void set_up(std::span<const double> parameters, Memory& memory) const noexcept override {
    of(memory).model = make_model<double>(scene_, parameters);
  }

  bool solves_closures() const override { return true; }

 private:
  static Procedure& of(Memory& memory) { return *std::any_cast<Procedure>(&memory.procedure); }
  void work_out(const Arguments& at, Memory& memory, double* outputs) const noexcept override {
    auto& [model, workspace] = of(memory);
    put_outputs<double>(purpose_, model, at.psi, at.psid, at.input, at.t, workspace, outputs);
  }

  const std::shared_ptr<const Scene> scene_;
  const Purpose purpose_;
};

}  // namespace

std::unique_ptr<const Routine> reference_routine(std::shared_ptr<const Scene> scene, Purpose purpose) {
  // The procedure evaluates; only its recording can be differentiated.
  if (purpose == Purpose::linearisation) {
    const Program program = trace(scene, purpose, Tracing::literal);
    if (program.outputs.empty())
      throw InputError("too_large", {scene->name},
                       fmt::format("its linearisation takes more than {} operations, which no program may; "
                                   "expected fewer coordinates, transforms or bodies",
                                   kMostOfDerivatives));
    return std::make_unique<Interpreter>(program);
  }
  return std::make_unique<Reference>(std::move(scene), purpose);
}

}  // namespace mixloop
