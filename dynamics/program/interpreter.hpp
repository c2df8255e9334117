// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/program/routine.hpp"
#include "dynamics/program/tape.hpp"

namespace mixloop {

/// Runs a program at once, without a compiler. Gives the same bits as its machine code.
class Interpreter final : public Routine {
 public:
  /// Where the next run finds its first operand and leaves its first result.
  struct Place {
    const Tape::Slot* operand;
    double* result;
  };
  /// Interprets one run of a tape; gives the place behind it.
  using Handler = Place (*)(std::uint32_t count, const double* values, const Tape::Slot* operand,
                            double* result);
  /// A run and what interprets it.
  struct Step {
    Handler handler;
    std::uint32_t count;
  };

  explicit Interpreter(const Program& program);

  Memory make_memory() const override { return {tape_.values, {}}; }
  void set_up(std::span<const double> parameters, Memory& memory) const noexcept override;

 private:
  void work_out(const Arguments& at, Memory& memory, double* outputs) const noexcept override;

  const Tape tape_;
  const std::vector<Step> set_up_, run_;
};

}  // namespace mixloop
