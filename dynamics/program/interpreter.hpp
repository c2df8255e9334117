// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/program/routine.hpp"
#include "dynamics/program/tape.hpp"

namespace mixloop {

/// Runs a program at once, without a compiler. Gives the same bits as its machine code.
class Interpreter final : public Routine {
 public:
  explicit Interpreter(const Program& program) : tape_(make_tape(program)) {}

  Memory make_memory() const override { return {tape_.values, {}}; }
  void set_up(std::span<const double> parameters, Memory& memory) const noexcept override;

 private:
  void work_out(const Arguments& at, Memory& memory, double* outputs) const noexcept override;

  const Tape tape_;
};

}  // namespace mixloop
