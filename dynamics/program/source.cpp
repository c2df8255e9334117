// SPDX-License-Identifier: MIT
#include "dynamics/program/source.hpp"

#include <fmt/format.h>

#include <cmath>

namespace mixloop {

extern const char* const kSincosText;       // generated from sincos.hpp
extern const char* const kSincosLanesText;  // generated from sincos_lanes.hpp

namespace {

using Stage = Program::Stage;

std::string number(double x) {
  if (std::isnan(x)) return "NAN";
  if (std::isinf(x)) return x < 0 ? "-HUGE_VAL" : "HUGE_VAL";
  if (x == std::floor(x) && std::fabs(x) < 1e6) return fmt::format("{:.1f}", x);
  return fmt::format("{:a}", x);
}

class Writer {
 public:
  Writer(const Program& program, const SourceStyle& style)
      : program_(program), style_(style), partner_(program.partners()), hoisted_(program.hoisted()) {
    name_.resize(program.nodes.size());
  }

  std::string write() {
    set_up();
    evaluation();
    exports();
    return std::move(text_);
  }

 private:
  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }

  void set_up() {
    line("extern \"C\" const int {}_constants = {};\n", style_.prefix, hoisted_.size());
    line("/* what depends on parameters alone */");
    line("extern \"C\" void {}_set_up(const double* parameters, double* k) {{", style_.prefix);
    line("  (void)parameters, (void)k;");
    statements(Stage::set_up, "double");
    for (std::size_t i = 0; i < hoisted_.size(); ++i) line("  k[{}] = {};", i, name_[hoisted_[i]]);
    line("}}\n");
  }

  void evaluation() {
    for (std::size_t i = 0; i < hoisted_.size(); ++i) name_[hoisted_[i]] = fmt::format("k[{}]", i);
    line("namespace {{\ntemplate <class Real>");
    line("inline void {}_run(const Real* psi, const Real* psid, const Real* input, Real t, const double* k, Real* out) {{",
         style_.prefix);
    line("  (void)psi, (void)psid, (void)input, (void)t, (void)k;");
    in_run_ = true;
    statements(Stage::run, "Real");
    for (std::size_t i = 0; i < program_.outputs.size(); ++i)
      line("  out[{}] = {};", i, as_real(program_.outputs[i]));
    line("}}\n}}  // namespace\n");
  }

  // A constant or set-up value as an output, which may be a vector of lanes.
  std::string as_real(NodeId id) const {
    return program_.stages[id] == Stage::run ? name_[id] : fmt::format("mixloop_lift<Real>({})", name_[id]);
  }

  void exports() {
    line("extern \"C\" void {0}(const double* psi, const double* psid, const double* input, double t, "
         "const double* k, double* out) {{\n  {0}_run<double>(psi, psid, input, t, k, out);\n}}",
         style_.prefix);
    if (!style_.lanes) return;
    for (int lanes : {4, 8})
      line("extern \"C\" void {0}_{1}(const double* psi, const double* psid, const double* input, const double* t, "
           "const double* k, double* out) {{\n"
           "  using Real = mixloop_lanes::Lanes{1};\n"
           "  {0}_run<Real>((const Real*)psi, (const Real*)psid, (const Real*)input, *(const Real*)t, k, (Real*)out);\n}}",
           style_.prefix, lanes);
  }

  void statements(Stage stage, const char* type) {
    for (NodeId id = 0; id < program_.nodes.size(); ++id) {
      const ExpressionNode& n = program_.nodes[id];
      if (n.op == Op::constant) name_[id] = number(n.value);
      if (program_.stages[id] != stage || n.op == Op::constant) continue;
      if (n.op == Op::input) {
        name_[id] = input(n);
      } else if (name_[id].empty() || stage == Stage::set_up) {
        statement(id, n, type);
      }
    }
  }

  static std::string input(const ExpressionNode& n) {
    constexpr const char* kNames[] = {"psi", "psid", "input", "t", "parameters"};
    return static_cast<Block>(n.a) == Block::time ? "t" : fmt::format("{}[{}]", kNames[n.a], n.b);
  }

  void statement(NodeId id, const ExpressionNode& n, const char* type) {
    if (n.op == Op::sin || n.op == Op::cos) return sine_and_cosine(id, n, type);
    name_[id] = fmt::format("v{}", id);
    line("  const {} v{} = {};", type, id, right_side(n));
  }

  std::string right_side(const ExpressionNode& n) const {
    const std::string& a = name_[n.a];
    switch (n.op) {
      case Op::neg: return "-" + a;
      case Op::add: return a + " + " + name_[n.b];
      case Op::sub: return a + " - " + name_[n.b];
      case Op::mul: return a + " * " + name_[n.b];
      case Op::div: return a + " / " + name_[n.b];
      case Op::sqrt: return fmt::format("mixloop_sqrt({})", a);
      case Op::exp: return fmt::format("mixloop_exp({})", a);
      case Op::log: return fmt::format("mixloop_log({})", a);
      case Op::atan2: return fmt::format("mixloop_atan2({}, {})", lifted(n.a), lifted(n.b));
      default: return a;
    }
  }

  std::string lifted(NodeId id) const { return in_run_ ? as_real(id) : name_[id]; }

  void sine_and_cosine(NodeId id, const ExpressionNode& n, const char* type) {
    const NodeId other = partner_[id];
    const NodeId sine = n.op == Op::sin ? id : other, cosine = n.op == Op::sin ? other : id;
    const std::string s = fmt::format("s{}", n.a), c = fmt::format("c{}", n.a);
    if (sine < name_.size()) name_[sine] = s;
    if (cosine < name_.size()) name_[cosine] = c;
    line("  {0} {1}, {2};\n  mixloop_sincos::sincos({3}, &{1}, &{2});", type, s, c, name_[n.a]);
  }

  const Program& program_;
  const SourceStyle& style_;
  std::vector<NodeId> partner_, hoisted_;
  std::vector<std::string> name_;
  std::string text_;
  bool in_run_ = false;
};

constexpr const char* kLibrarySincos = R"(
namespace mixloop_sincos {
inline void sincos(double x, double* sine, double* cosine) {
  *sine = sin(x);
  *cosine = cos(x);
}
}
)";

constexpr const char* kFunctions = R"(
namespace {
template <class Real>
inline Real mixloop_lift(double x) { return x - Real(); }
inline double mixloop_sqrt(double x) { return sqrt(x); }
inline double mixloop_exp(double x) { return exp(x); }
inline double mixloop_log(double x) { return log(x); }
inline double mixloop_atan2(double y, double x) { return atan2(y, x); }
}  // namespace
)";

}  // namespace

std::string source_head(const SourceStyle& style) {
  std::string head = "#include <math.h>\n";
  head += style.trigonometry == Trigonometry::inlined ? kSincosText : kLibrarySincos;
  head += kFunctions;
  if (style.lanes) head += kSincosLanesText;
  return head;
}

std::string source_of(const Program& program, const SourceStyle& style) { return Writer(program, style).write(); }

}  // namespace mixloop
