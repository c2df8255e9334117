// SPDX-License-Identifier: MIT
#include "dynamics/program/lanes.hpp"

#include "dynamics/program/source.hpp"

namespace mixloop {
namespace {

int native_width() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx512f") ? 8 : 4;
#else
  return 4;
#endif
}

}  // namespace

std::unique_ptr<LaneCode> LaneCode::load(const std::string& key, const std::function<Program()>& trace,
                                         std::string& complaint) {
  SourceStyle style;
  style.lanes = true;
  auto code = std::make_unique<LaneCode>();
  code->width_ = native_width();
  auto source = [&] { return source_head(style) + source_of(trace(), style); };
  code->library_ = SharedObject::cached("lanes:" + key, source, complaint);
  if (!code->library_) return nullptr;
  const std::string name = style.prefix + "_" + std::to_string(code->width_);
  code->set_up_ = reinterpret_cast<SetUp>(code->library_.symbol(style.prefix + "_set_up"));
  code->evaluate_ = reinterpret_cast<Evaluate>(code->library_.symbol(name));
  const auto* count = static_cast<const int*>(code->library_.symbol(style.prefix + "_constants"));
  if (code->set_up_ == nullptr || code->evaluate_ == nullptr || count == nullptr) {
    complaint = "the built program lacks its functions";
    return nullptr;
  }
  code->constants_.resize(static_cast<std::size_t>(*count));
  return code;
}

}  // namespace mixloop
