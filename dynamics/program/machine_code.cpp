// SPDX-License-Identifier: MIT
#include "dynamics/program/machine_code.hpp"

#include "dynamics/program/source.hpp"

namespace mixloop {

std::unique_ptr<MachineCode> MachineCode::load(const std::string& key, const std::function<Program()>& trace,
                                               std::string& complaint) {
  const SourceStyle style;
  auto source = [&] { return source_head(style) + source_of(trace(), style); };
  auto code = std::make_unique<MachineCode>();
  code->library_ = SharedObject::cached("program:" + key, source, complaint);
  if (!code->library_) return nullptr;
  code->set_up_ = reinterpret_cast<SetUp>(code->library_.symbol(style.prefix + "_set_up"));
  code->evaluate_ = reinterpret_cast<Evaluate>(code->library_.symbol(style.prefix));
  const auto* count = static_cast<const int*>(code->library_.symbol(style.prefix + "_constants"));
  if (code->set_up_ == nullptr || code->evaluate_ == nullptr || count == nullptr) {
    complaint = "the built program lacks its functions";
    return nullptr;
  }
  code->constants_.resize(static_cast<std::size_t>(*count));
  return code;
}

void MachineCode::set_up(std::span<const double> parameters) noexcept {
  set_up_(parameters.data(), constants_.data());
}

void MachineCode::run(const double* psi, const double* psid, const double* input, double t, double* outputs) noexcept {
  evaluate_(psi, psid, input, t, constants_.data(), outputs);
}

}  // namespace mixloop
