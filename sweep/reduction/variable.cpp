// SPDX-License-Identifier: MIT
#include "sweep/reduction/variable.hpp"

#include <algorithm>

namespace mixloop {

std::vector<Variable> variables_of(const KeptSweep& sweep) {
  using Kind = Variable::Kind;
  std::vector<Variable> variables;
  for (const Variation& one : sweep.design.variations()) {
    const Kind kind = one.distribution ? Kind::drawn : one.is_number() ? Kind::listed : Kind::words;
    variables.push_back({.name = one.key, .unit = one.unit, .kind = kind, .words = one.texts});
  }
  for (const auto& column : sweep.columns)
    variables.push_back({.name = column.name,
                         .unit = column.unit == "1" ? "" : column.unit,
                         .least_is_worst = column.name == "diverged_at" || column.name == "safe_at"});
  variables.push_back({.name = "not held", .unit = "", .kind = Kind::held, .words = {"held", "not held"}});
  return variables;
}

const Outcome& VariableReader::read(const Outcome& outcome) {
  const std::size_t entries = design_->variations().size();
  read_.run = outcome.run;
  read_.end = outcome.end;
  read_.code = outcome.code;
  read_.values.resize(entries + outcome.values.size() + 1);
  design_->numbers(outcome.run, std::span(read_.values).first(entries));
  std::ranges::copy(outcome.values, read_.values.begin() + static_cast<std::ptrdiff_t>(entries));
  read_.values.back() = outcome.end == RunEnd::held ? 0 : 1;
  return read_;
}

}  // namespace mixloop
