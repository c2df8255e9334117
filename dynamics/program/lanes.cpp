// SPDX-License-Identifier: MIT
#include "dynamics/program/lanes.hpp"

#include "dynamics/program/processor.hpp"
#include "dynamics/program/source.hpp"

namespace mixloop {

std::unique_ptr<LaneCode> LaneCode::load(const std::string& key, const std::function<Program()>& trace,
                                         std::string& complaint) {
  SourceStyle style;
  style.lanes = true;
  auto code = std::make_unique<LaneCode>();
  code->width_ = lane_width();
  auto source = [&] { return source_head(style) + source_of(trace(), style); };
  SharedObject library = SharedObject::cached("lanes:" + key, source, complaint);
  const std::string name = style.prefix + "_" + std::to_string(code->width_);
  if (!code->emitted_.load(std::move(library), style.prefix, name, complaint)) return nullptr;
  return code;
}

std::vector<double> LaneCode::constants(std::span<const double> parameters) const {
  std::vector<double> constants(emitted_.constants());
  emitted_.set_up(parameters, constants);
  return constants;
}

}  // namespace mixloop
