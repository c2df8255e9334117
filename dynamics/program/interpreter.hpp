// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/program/routine.hpp"
#include "dynamics/program/tape.hpp"

namespace mixloop {

/// Runs a program at once, without a compiler. Gives the same bits as its machine code.
class Interpreter final : public Routine {
 public:
  explicit Interpreter(const Program& program) : tape_(make_tape(program)) {}

  void set_up(std::span<const double> parameters) noexcept override;
  void run(const double* psi, const double* psid, const double* input, double t,
           double* outputs) noexcept override;

 private:
  Tape tape_;
};

}  // namespace mixloop
