// SPDX-License-Identifier: MIT
#pragma once

#include <span>

namespace mixloop {

/// The inputs of one evaluation; `input` holds what else the purpose takes (tau, psidd or a).
struct Arguments {
  const double* psi = nullptr;
  const double* psid = nullptr;
  const double* input = nullptr;
  double t = 0.0;
};

/// A program ready to run, interpreted or compiled. Holds the memory that an evaluation needs, so a
/// routine belongs to one thread.
class Routine {
 public:
  virtual ~Routine() = default;

  /// Runs the set-up part: once before the first evaluation, and again when a parameter changes.
  virtual void set_up(std::span<const double> parameters) noexcept = 0;
  /// Writes the outputs. No allocation, lock or exception.
  virtual void run(const double* psi, const double* psid, const double* input, double t,
                   double* outputs) noexcept = 0;

  void evaluate(const Arguments& in, double* outputs) noexcept {
    run(in.psi, in.psid, in.input, in.t, outputs);
  }
};

}  // namespace mixloop
