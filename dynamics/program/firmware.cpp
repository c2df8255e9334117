// SPDX-License-Identifier: MIT
#include "dynamics/program/firmware.hpp"

#include <fmt/format.h>

#include "dynamics/program/trace.hpp"
#include "notation/sha256.hpp"

namespace mixloop {
namespace {

// What a purpose's `input` and `out` hold, column by column.
std::string_view meaning(Purpose purpose) {
  switch (purpose) {
    case Purpose::forward_dynamics:
      return "input: tau (n); out: psidd (n)";
    case Purpose::mass_times:
      return "input: a (n); out: M a (n)";
    case Purpose::mass_matrix:
      return "input: none; out: M (n x n)";
    case Purpose::bias:
      return "input: none; out: h (n)";
    case Purpose::inverse_dynamics:
      return "input: psidd (n); out: M psidd + h (n)";
    case Purpose::end_effector:
      return "input: psidd (n); out: position, velocity, acceleration (3 each), Jacobian (3 x n)";
    case Purpose::energy:
      return "input: none; out: kinetic energy, potential";
    case Purpose::linearisation:
      return "input: tau (n); out: d psidd / d psi, d psidd / d psid, d psidd / d tau (n x n each)";
    case Purpose::dynamics_and_mass_times:
      return "input: tau, a (n each); out: psidd, M a (n each)";
  }
  return "";
}

std::string prefix_of(Purpose purpose) { return "mixloop_" + std::string(name_of(purpose)); }

}  // namespace

std::string firmware_source(const std::shared_ptr<const Scene>& scene, const std::vector<Purpose>& purposes,
                            Trigonometry trigonometry) {
  std::string head = fmt::format(
      "// Equations of motion, written by mixloop. M(psi) psidd + h(psi, psid) = tau, SI units, radians.\n"
      "// Scene: SHA-256 {}, {} independent and {} dependent coordinates, {} parameters.\n"
      "//\n"
      "// double k[PREFIX_constants]; PREFIX_set_up(parameters, k);      once, and when a parameter changes\n"
      "// PREFIX(psi, psid, input, t, k, out);                           an evaluation; matrices column by "
      "column\n"
      "//\n",
      sha256_hex(scene->canonical), scene->n(), scene->m(), scene->parameters.size());
  std::string body;
  for (Purpose purpose : purposes) {
    SourceStyle style;
    style.prefix = prefix_of(purpose);
    style.trigonometry = trigonometry;
    const TracedProgram traced = trace(scene, purpose);
    head += fmt::format("// {}: {}\n//   {}; set-up {}\n", style.prefix, meaning(purpose),
                        traced.program.run_operations().text(), traced.program.set_up_operations().text());
    body += source_of(traced.program, style);
  }
  SourceStyle style;
  style.trigonometry = trigonometry;
  return head + "\n" + source_head(style) + "\n" + body;
}

}  // namespace mixloop
