// SPDX-License-Identifier: MIT
#include "sweep/kernel/kernel_source.hpp"

#include <fmt/format.h>

#include "dynamics/program/source.hpp"
#include "dynamics/program/trace.hpp"
#include "notation/sha256.hpp"

namespace mixloop {

extern const char* const kClosedLoopText;
extern const char* const kOnDeviceText;

namespace {

/// One of the loop's programs, and the member of Programs that calls it.
struct LoopProgram {
  const char* name;
  const char* takes;
  Program program;
};

std::string member(const LoopProgram& part) {
  const bool is_empty = part.program.outputs.empty();
  return fmt::format(
      "  static constexpr int {0}_constants = {1};\n"
      "  template <class Real>\n"
      "  MIXLOOP_INLINE static void {0}({2}, Real t, const Real* k, Real* out) {{\n"
      "    (void)psi, (void)psid, (void)input, (void)t, (void)k, (void)out;\n{3}  }}\n",
      part.name, part.program.hoisted().size(), "const Real* psi, const Real* psid, const Real* input",
      is_empty ? "" : fmt::format("    {}_run<Real, Real>(psi, psid, input, t, k, out);\n", part.name));
}

constexpr const char* kOnLanes = R"(
#define MIXLOOP_CLOSED_LOOPS(lanes, Real)                                                                          \
  extern "C" void closed_loops_##lanes(const mixloop_loop::Common* common, const mixloop_loop::Each* each,         \
                                       const mixloop_loop::Told* told, int first) {                                \
    mixloop_loop::Loop<Real, Programs>(*common, *each, *told, first).run();                                        \
  }
MIXLOOP_CLOSED_LOOPS(1, double)
MIXLOOP_CLOSED_LOOPS(4, mixloop_lanes::Lanes4)
MIXLOOP_CLOSED_LOOPS(8, mixloop_lanes::Lanes8)
)";

constexpr const char* kOnCuda = R"(
#if defined(__CUDACC__)
extern "C" const char* closed_loops_on_device(const mixloop_loop::Common* common, const mixloop_loop::Each* each,
                                              const mixloop_loop::Told* told) {
  return mixloop_loop::closed_loops_on_device<Programs>(*common, *each, *told);
}
#endif
// The same on the host.
extern "C" void closed_loops_1(const mixloop_loop::Common* common, const mixloop_loop::Each* each,
                               const mixloop_loop::Told* told, int first) {
  mixloop_loop::Loop<double, Programs>(*common, *each, *told, first).run();
}
)";

}  // namespace

std::string KernelParts::key() const {
  static const std::string text = sha256_hex(std::string(kClosedLoopText) + kOnDeviceText);
  return fmt::format("closed loop {} {} {} {} {}\n{}\n{}", text, feedforward, bias, sensors, drives,
                     plant->canonical, controller->canonical);
}

std::string kernel_source(const KernelParts& parts, KernelTarget target) {
  SourceStyle style;
  style.lanes = target == KernelTarget::processor;
  style.exported = false;
  std::vector<LoopProgram> all;
  all.push_back({"plant", "tau", trace(parts.plant, Purpose::forward_dynamics).program});
  all.push_back({"hand", "", first_outputs(trace(parts.plant, Purpose::end_effector).program, 3)});
  all.push_back({"mass", "psidd",
                 parts.feedforward ? trace(parts.controller, Purpose::mass_times).program : Program()});
  all.push_back({"bias", "", parts.bias ? trace(parts.controller, Purpose::bias).program : Program()});
  std::string text = source_head(style), members;
  for (const LoopProgram& part : all) {
    style.prefix = part.name;
    if (!part.program.outputs.empty()) text += source_of(part.program, style);
    members += member(part);
  }
  text += kClosedLoopText;
  if (target == KernelTarget::cuda) text += kOnDeviceText;
  text += fmt::format(
      "\nnamespace {{\nstruct Programs {{\n  static constexpr int n = {}, n_u = {};\n"
      "  static constexpr bool sensors = {}, drives = {};\n{}}};\n}}\n",
      parts.plant->n(), parts.plant->n_u(), parts.sensors, parts.drives, members);
  return text + (target == KernelTarget::processor ? kOnLanes : kOnCuda);
}

}  // namespace mixloop
