// SPDX-License-Identifier: MIT
#include "dynamics/program/firmware.hpp"

#include <fmt/format.h>

#include "dynamics/program/trace.hpp"
#include "notation/errors.hpp"
#include "notation/sha256.hpp"

namespace mixloop {
namespace {

std::string prefix_of(Purpose purpose) { return "mixloop_" + std::string(name_of(purpose)); }

/// The solver of a scene's closures: corrections are repeated until they are none, as in ClosureFollower.
void add_closures(const std::shared_ptr<const Scene>& scene, Trigonometry trigonometry, std::string& head,
                  std::string& body) {
  SourceStyle style;
  style.prefix = "mixloop_closures";
  style.trigonometry = trigonometry;
  const Program program = trace_closures(scene);
  body += source_of(program, style);
  const int start = scene->start_size(), corrections = scene->corrections();
  head += fmt::format(
      "// mixloop_closures: input: start ({}); out: {} numbers: derivatives of the started coordinates by "
      "psi and "
      "t, the closures' rows, conditions, the solution ({}), corrections ({})\n",
      start, program.outputs.size(), start, corrections);
  if (corrections == 0) return;
  head += fmt::format(
      "// Where chains close, `input` goes on with a start ({} numbers: of each solved coordinate its value "
      "and, of "
      "an angle, cosine and sine) and `out` with the solution ({}) and the last corrections ({}, rad or "
      "m){}.\n"
      "// mixloop_solve(psi, t, k, start): k of mixloop_closures; start: that of a pose nearby, solved in "
      "place. "
      "0, or 1 where there is no solution nearby.\n//\n",
      start, start, corrections,
      scene->started_rates() > 0
          ? fmt::format(", and their derivatives by psi and t ({})", scene->started_rates())
          : "");
  body += fmt::format(
      R"(
extern "C" int mixloop_solve(const double* psi, double t, const double* k, double* start) {{
  double out[{}];
  for (int repeat = 0; repeat < 8; ++repeat) {{
    mixloop_closures(psi, psi, start, t, k, out);
    double largest = 0;
    for (int i = {}; i < {}; ++i) {{
      if (!(out[i] - out[i] == 0)) return 1;
      if (out[i] > largest) largest = out[i];
      if (-out[i] > largest) largest = -out[i];
    }}
    for (int i = 0; i < {}; ++i) start[i] = out[{} + i];
    if (largest < 1e-9) return 0;
  }}
  return 1;
}}
)",
      program.outputs.size(), static_cast<int>(program.outputs.size()) - corrections, program.outputs.size(),
      start, static_cast<int>(program.outputs.size()) - corrections - start);
}

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
    if (traced.program.outputs.empty() && output_size(purpose, scene->n(), scene->n_u()) > 0)
      throw InputError("too_large", {scene->name},
                       fmt::format("{} takes more operations than a program may; expected fewer coordinates, "
                                   "transforms or bodies",
                                   name_of(purpose)));
    head += fmt::format("// {}: input: {}; out: {}\n//   {}; set-up {}\n", style.prefix,
                        signature(purpose).takes, signature(purpose).gives,
                        traced.program.run_operations().text(), traced.program.set_up_operations().text());
    body += source_of(traced.program, style);
  }
  if (scene->is_closed()) add_closures(scene, trigonometry, head, body);
  SourceStyle style;
  style.trigonometry = trigonometry;
  return head + "\n" + source_head(style) + "\n" + body;
}

}  // namespace mixloop
