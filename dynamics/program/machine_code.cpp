// SPDX-License-Identifier: MIT
#include "dynamics/program/machine_code.hpp"

#include "dynamics/program/source.hpp"

namespace mixloop {

bool is_compiled(const Program& program) {
  const OperationCount run = program.run_operations();
  return !program.outputs.empty() && run.flops() + run.sincos <= kMostCompiledOperations;
}

std::string MachineCode::hindrance() { return SharedObject::hindrance(); }

std::unique_ptr<MachineCode> MachineCode::load(const std::string& key, const std::function<Program()>& trace,
                                               std::string& complaint, std::optional<int> steps_of) {
  const SourceStyle style{.steps_of = steps_of};
  const auto source = [&] {
    const Program program = trace();
    return is_compiled(program) ? source_head(style) + source_of(program, style) : std::string();
  };
  auto code = std::make_unique<MachineCode>();
  SharedObject library = SharedObject::cached("program:" + key, source, complaint);
  if (!code->emitted_.load(std::move(library), style.prefix, style.prefix, complaint)) return nullptr;
  code->code_ = code->emitted_.evaluate();
  code->steps_ = code->emitted_.steps();
  return code;
}

}  // namespace mixloop
