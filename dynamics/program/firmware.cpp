// SPDX-License-Identifier: MIT
#include "dynamics/program/firmware.hpp"

#include <fmt/format.h>

#include "dynamics/program/trace.hpp"
#include "notation/errors.hpp"
#include "notation/sha256.hpp"

namespace mixloop {
namespace {

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
    if (traced.program.outputs.empty())
      throw InputError("too_large", {scene->name},
                       fmt::format("{} takes more operations than a program may; expected fewer coordinates, "
                                   "transforms or bodies",
                                   name_of(purpose)));
    head += fmt::format("// {}: input: {}; out: {}\n//   {}; set-up {}\n", style.prefix,
                        signature(purpose).takes, signature(purpose).gives,
                        traced.program.run_operations().text(), traced.program.set_up_operations().text());
    body += source_of(traced.program, style);
  }
  SourceStyle style;
  style.trigonometry = trigonometry;
  return head + "\n" + source_head(style) + "\n" + body;
}

}  // namespace mixloop
