// SPDX-License-Identifier: MIT
#include "dynamics/program/source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "dynamics/program/routine.hpp"
#include "dynamics/program/statements.hpp"
#include "dynamics/symbolic/operations.hpp"

namespace mixloop {

// Generated from the files of these names.
extern const char* const kFusedText;
extern const char* const kElementaryText;
extern const char* const kSincosText;
extern const char* const kLanesText;
extern const char* const kStepsText;

namespace {

using Stage = Program::Stage;

// As emitted functions call it.
const char* name_of(Block block) {
  constexpr const char* kNames[kBlocks] = {"psi", "psid", "input", "t", "parameters"};
  return kNames[static_cast<std::size_t>(block)];
}

std::string number(double x) {
  if (std::isnan(x)) return "NAN";
  if (std::isinf(x)) return x < 0 ? "-HUGE_VAL" : "HUGE_VAL";
  if (x == std::floor(x) && std::fabs(x) < 1e6) return fmt::format("{:.1f}", x);
  return fmt::format("{:a}", x);
}

// Longer programs are written in parts of so many statements.
constexpr std::size_t kMostSteps = 1000;

// The work of more is a sum in another order than a plant's.
constexpr int kMostMotorsOfSteps = 3;

class Writer {
 public:
  Writer(const Program& program, const SourceStyle& style)
      : program_(program), style_(style), hoisted_(program.hoisted()) {
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
    write_all(Stage::set_up, "double");
    for (std::size_t i = 0; i < hoisted_.size(); ++i) line("  k[{}] = {};", i, name_[hoisted_[i]]);
    line("}}\n");
  }

  static constexpr const char* kTakes =
      "const Real* psi, const Real* psid, const Real* input, Real t, const K* k, Real* ";

  void evaluation() {
    for (std::size_t i = 0; i < hoisted_.size(); ++i) name_[hoisted_[i]] = fmt::format("k[{}]", i);
    in_run_ = true;
    name_leaves(Stage::run);
    const std::vector<Statement> steps = statements_.of(Stage::run);
    line("namespace {{");
    const std::size_t parts = steps.size() <= kMostSteps ? 0 : write_parts(steps);
    line("template <class Real, class K>\nMIXLOOP_FUNCTION inline void {}_run({}out) {{", style_.prefix,
         kTakes);
    line("  (void)psi, (void)psid, (void)input, (void)t, (void)k;");
    if (parts > 0) line("  Real w[{}];", slots_);
    for (std::size_t i = 0; i < parts; ++i)
      line("  {}_part_{}<Real, K>(psi, psid, input, t, k, w);", style_.prefix, i);
    if (parts == 0)
      for (const Statement& step : steps) write(step, "Real");
    for (std::size_t i = 0; i < program_.outputs.size(); ++i)
      line("  out[{}] = {};", i, as_real(program_.outputs[i]));
    line("}}\n}}  // namespace\n");
  }

  // A long program in functions of their own, what one leaves for the next in w: the compiler's time grows
  // faster than a function's length. Returns how many.
  std::size_t write_parts(const std::vector<Statement>& steps) {
    const std::size_t count = (steps.size() + kMostSteps - 1) / kMostSteps;
    std::vector<std::size_t> last(program_.nodes.size(), 0);  // the part that uses a value last
    for (std::size_t s = 0; s < steps.size(); ++s)
      for (NodeId id : statements_.takes(steps[s])) last[id] = s / kMostSteps;
    for (NodeId output : program_.outputs) last[output] = count;
    std::vector<std::vector<std::size_t>> freed(count + 1);
    std::vector<std::size_t> idle;
    for (std::size_t part = 0; part < count; ++part) {
      line("template <class Real, class K>\nMIXLOOP_PART void {}_part_{}({}w) {{", style_.prefix, part,
           kTakes);
      line("  (void)psi, (void)psid, (void)input, (void)t, (void)k;");
      const auto from = steps.begin() + static_cast<std::ptrdiff_t>(part * kMostSteps);
      const auto to = part + 1 == count ? steps.end() : from + static_cast<std::ptrdiff_t>(kMostSteps);
      std::for_each(from, to, [&](const Statement& step) { write(step, "Real"); });
      for (auto step = from; step != to; ++step)
        for (NodeId id : statements_.gives(*step)) {
          if (last[id] <= part) continue;
          std::size_t slot = slots_;
          if (idle.empty())
            ++slots_;
          else
            slot = idle.back(), idle.pop_back();
          freed[last[id]].push_back(slot);
          line("  w[{}] = {};", slot, name_[id]);
          name_[id] = fmt::format("w[{}]", slot);
        }
      line("}}\n");
      idle.insert(idle.end(), freed[part].begin(), freed[part].end());
    }
    return count;
  }

  // A constant or set-up value as an output, which may be a vector of lanes.
  std::string as_real(NodeId id) const {
    return program_.stages[id] == Stage::run ? name_[id]
                                             : fmt::format("mixloop_functions::lift<Real>({})", name_[id]);
  }

  void exports() {
    if (!style_.exported) return;
    line(
        "extern \"C\" void {0}(const double* psi, const double* psid, const double* input, double t, "
        "const double* k, double* out) {{\n  {0}_run<double, double>(psi, psid, input, t, k, out);\n}}",
        style_.prefix);
    if (style_.steps_of) export_steps(*style_.steps_of);
    if (!style_.lanes) return;
    for (int lanes : {4, 8}) export_lanes(lanes);
  }

  void export_steps(int motors) {
    if (motors > kMostMotorsOfSteps) return;
    for (StepsBy method : kStepsBy)
      line(
          "extern \"C\" void {0}_{1}(double* x, const double* input, double t, double h, int steps, "
          "const double* k) {{\n"
          "  mixloop_steps::{1}<{2}, {3}>(x, input, t, h, steps, "
          "[=](const double* psi, const double* psid, double at, double* psidd) {{\n"
          "    {0}_run<double, double>(psi, psid, input, at, k, psidd);\n  }});\n}}",
          style_.prefix, name_of(method), program_.outputs.size(), motors);
  }

  // The caller's memory is aligned for doubles only: whole vectors are loaded and stored loosely.
  void export_lanes(int lanes) {
    line(
        "extern \"C\" void {0}_{1}(const double* psi, const double* psid, const double* input, "
        "const double* t, const double* k, double* out) {{\n  using Real = mixloop_lanes::Lanes{1};\n"
        "  using Loose = mixloop_lanes::Vectors<{1}>::Loose;",
        style_.prefix, lanes);
    std::string arguments;
    for (Block block : {Block::psi, Block::psid, Block::input, Block::time}) {
      const char* name = name_of(block);
      std::size_t used = 0;
      for (const ExpressionNode& n : program_.nodes)
        if (n.op == Op::input && static_cast<Block>(n.a) == block)
          used = std::max<std::size_t>(used, n.b + 1);
      std::string loads;
      for (std::size_t i = 0; i < used; ++i) loads += fmt::format("((const Loose*){})[{}], ", name, i);
      line("  const Real {0}_in[] = {{{1}}};\n  (void){0};", name, used > 0 ? loads : "Real()");
      arguments += fmt::format("{}_in{}, ", name, block == Block::time ? "[0]" : "");
    }
    line("  Real results[{}];\n  {}_run<Real, double>({}k, results);",
         std::max<std::size_t>(program_.outputs.size(), 1), style_.prefix, arguments);
    for (std::size_t i = 0; i < program_.outputs.size(); ++i) line("  ((Loose*)out)[{0}] = results[{0}];", i);
    line("}}");
  }

  void name_leaves(Stage stage) {
    for (NodeId id = 0; id < program_.nodes.size(); ++id) {
      const ExpressionNode& n = program_.nodes[id];
      if (n.op == Op::constant) name_[id] = number(n.value);
      if (n.op == Op::input && program_.stages[id] == stage) name_[id] = input(n);
    }
  }

  void write_all(Stage stage, const char* type) {
    name_leaves(stage);
    for (const Statement& step : statements_.of(stage)) write(step, type);
  }

  void write(const Statement& step, const char* type) {
    if (!step.batch.empty()) return sines_and_cosines(step, type);
    name_[step.node] = fmt::format("v{}", step.node);
    line("  const {} v{} = {};", type, step.node, right_side(program_.nodes[step.node]));
  }

  static std::string input(const ExpressionNode& n) {
    const Block block = static_cast<Block>(n.a);
    return block == Block::time ? name_of(block) : fmt::format("{}[{}]", name_of(block), n.b);
  }

  std::string right_side(const ExpressionNode& n) const {
    const Operation& row = operation(n.op);
    const bool is_function = row.text.size() > 1;
    if (!is_function && row.arity == 1) return fmt::format("{}{}", row.text, name_[n.a]);
    if (!is_function) return fmt::format("{} {} {}", name_[n.a], row.text, name_[n.b]);
    std::string arguments = lifted(n.a);
    if (row.arity > 1) arguments += ", " + lifted(n.b);
    if (row.arity > 2) arguments += ", " + lifted(n.c);
    return fmt::format("{}({})", row.text, arguments);
  }

  std::string lifted(NodeId id) const { return in_run_ ? as_real(id) : name_[id]; }

  void sines_and_cosines(const Statement& step, const char* type) {
    const std::vector<NodeId>& batch = step.batch;
    const std::size_t first = batches_++, count = batch.size();
    line("  {0} s{1}[{2}], c{1}[{2}];", type, first, count);
    if (step.angles.empty()) {
      std::string angles;
      for (NodeId angle : batch) angles += (angles.empty() ? "" : ", ") + name_[angle];
      line("  const {0} a{1}[] = {{{2}}};\n  mixloop_functions::sincos_of<{3}>(a{1}, s{1}, c{1});", type,
           first, angles, count);
    } else {
      affine_angles(step.angles, type, first);
    }
    for (std::size_t i = 0; i < count; ++i)
      for (NodeId id : statements_.pair_of(batch[i]))
        name_[id] = fmt::format("{}{}[{}]", program_.nodes[id].op == Op::sin ? 's' : 'c', first, i);
  }

  // A row of factors for each coordinate that one of the angles has.
  void affine_angles(const std::vector<AffineAngle>& angles, const char* type, std::size_t first) {
    std::map<NodeId, std::vector<double>> rows;
    for (std::size_t i = 0; i < angles.size(); ++i)
      for (const auto& [index, factor] : angles[i].terms)
        rows.try_emplace(index, angles.size(), 0.0).first->second[i] = factor;
    std::string coordinates, factors;
    const auto row_of = [](const std::vector<double>& row) {
      std::string text;
      for (double x : row) text += (text.empty() ? "" : ", ") + number(x);
      return text;
    };
    for (const auto& [index, row] : rows) {
      coordinates += fmt::format("{}psi[{}]", coordinates.empty() ? "" : ", ", index);
      factors += fmt::format("{}{{{}}}", factors.empty() ? "" : ", ", row_of(row));
    }
    std::vector<double> offsets;
    for (const AffineAngle& angle : angles) offsets.push_back(angle.constant);
    line(
        "  const {0} q{1}[] = {{{2}}};\n  constexpr double f{1}[{3}][{4}] = {{{5}}}, o{1}[] = {{{6}}};\n"
        "  mixloop_functions::sincos_of_affine(q{1}, f{1}, o{1}, s{1}, c{1});",
        type, first, coordinates, rows.size(), angles.size(), factors, row_of(offsets));
  }

  const Program& program_;
  const SourceStyle& style_;
  Statements statements_{program_};
  std::vector<NodeId> hoisted_;
  std::vector<std::string> name_;
  std::string text_;
  std::size_t batches_ = 0, slots_ = 0;
  bool in_run_ = false;
};

constexpr const char* kLibrarySincos = R"(
namespace mixloop_functions {
MIXLOOP_INLINE void sincos(double x, double* sine, double* cosine) {
  *sine = sin(x);
  *cosine = cos(x);
}
template <int kCount>
MIXLOOP_INLINE void sincos_of(const double (&x)[kCount], double (&sine)[kCount], double (&cosine)[kCount]) {
#if defined(__GNUC__)
#pragma GCC unroll 4
#endif
  for (int i = 0; i < kCount; ++i) sincos(x[i], sine + i, cosine + i);
}
template <int kTerms, int kCount>
MIXLOOP_INLINE void sincos_of_affine(const double (&q)[kTerms], const double (&factor)[kTerms][kCount],
                                     const double (&constant)[kCount], double (&sine)[kCount],
                                     double (&cosine)[kCount]) {
#if defined(__GNUC__)
#pragma GCC unroll 4
#endif
  for (int i = 0; i < kCount; ++i) {
    double x = constant[i];
#if defined(__GNUC__)
#pragma GCC unroll 4
#endif
    for (int k = 0; k < kTerms; ++k)
      if (factor[k][i] != 0) x = fma(q[k], factor[k][i], x);
    sincos(x, sine + i, cosine + i);
  }
}
}  // namespace mixloop_functions
)";

constexpr const char* kFunctions = R"(
#if defined(MIXLOOP_VECTORS)
#define MIXLOOP_PART inline __attribute__((noinline))
#else
#define MIXLOOP_PART MIXLOOP_FUNCTION inline
#endif
namespace mixloop_functions {
MIXLOOP_INLINE double root(double x) { return sqrt(x); }
}  // namespace mixloop_functions
)";

}  // namespace

std::string source_head(const SourceStyle& style) {
  // Vectors are passed among functions that are inlined alone: no calling convention matters.
  std::string head = "#if defined(__GNUC__)\n#pragma GCC diagnostic ignored \"-Wpsabi\"\n#endif\n";
  head += kFusedText;
  head += style.trigonometry == Trigonometry::inlined ? kSincosText : kLibrarySincos;
  head += kElementaryText;
  head += kFunctions;
  if (style.lanes) head += kLanesText;
  if (style.steps_of) head += kStepsText;
  return head;
}

std::string source_of(const Program& program, const SourceStyle& style) {
  return Writer(program, style).write();
}

}  // namespace mixloop
