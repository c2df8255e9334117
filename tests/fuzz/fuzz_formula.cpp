// SPDX-License-Identifier: MIT
// A formula, with symbols and constants to use, evaluated where it is one.
#include "notation/document.hpp"
#include "notation/formula.hpp"
#include "tests/fuzz/check.hpp"

namespace {

using namespace mixloop;

Node scalar(std::string_view text) {
  Node node;
  node.kind = Node::Kind::scalar;
  node.text = text;
  node.place = {"fuzz", 1, 1};
  return node;
}

const Scope& scope() {
  static const Scope made = [] {
    Scope names;
    names.define_symbol("x", 0, kPure, {});
    names.define_symbol("y", 1, kLength, {});
    names.define_symbol("t", 2, kTime, {});
    names.define_formula("two", parse_formula(scalar("2"), "a formula", names), {});
    names.define_formula("len", parse_formula(scalar("(1 m + y)^2 / 3 m"), "a formula", names), {});
    return names;
  }();
  return made;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = text_of(data, size);
  if (first_non_text(text)) return 0;  // no document has such a scalar
  names_in(text);
  refuses_or_reads("fuzz", [&] {
    const Formula formula = parse_formula(scalar(text), "a formula", scope());
    require(!formula.is_constant() || std::isfinite(formula.constant()), "a constant is finite");
    require(formula.nodes.size() <= 4096 && formula.height <= 256, "a formula is bounded");
    evaluate<double>(formula, [](int symbol) { return 0.3 + symbol; });
    degree(formula, [](int symbol) { return symbol == 0; });
    to_string(formula.dimension);
  });
  return 0;
}
