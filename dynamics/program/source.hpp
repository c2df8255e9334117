// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "dynamics/program/program.hpp"

namespace mixloop {

/// Which sine and cosine emitted code calls.
enum class Trigonometry : std::uint8_t {
  inlined,    ///< notation/functions/sincos.hpp, in the text: the same bits everywhere, vectorisable
  c_library,  ///< sin and cos of <math.h>
};

/// How a program is written as C++17.
struct SourceStyle {
  std::string prefix = "mixloop";  ///< of the exported names; letters, digits and _
  Trigonometry trigonometry = Trigonometry::inlined;
  bool lanes = false;           ///< also evaluations on 4 and 8 states at once (GCC's vectors)
  std::optional<int> steps_of;  ///< of forward dynamics of so many motors, also whole steps
  bool exported =
      true;  ///< else PREFIX_run<Real, K> alone, a template on numbers and on what the set-up left
};

/// The head of an emitted file: what it needs, and sine and cosine.
std::string source_head(const SourceStyle& style);

/// The program as C++ functions of a C interface:
///
///     void PREFIX_set_up(const double* parameters, double* k);
///     void PREFIX(const double* psi, const double* psid, const double* input, double t,
///                 const double* k, double* out);
///     extern const int PREFIX_constants;   // how many doubles k has
///
/// with lanes PREFIX_4 and PREFIX_8, where each input and output is 4 or 8 consecutive doubles, and with
/// steps
///
///     void PREFIX_rk4(double* x, const double* input, double t, double h, int steps, const double* k);
///
/// and PREFIX_leapfrog (steps_text.hpp), where there are no more than three motors: the sum that is the work
/// of more has another order in a plant. Identifiers are generated and constants are exact (hexadecimal): no
/// text of the scene goes in.
std::string source_of(const Program& program, const SourceStyle& style);

}  // namespace mixloop
