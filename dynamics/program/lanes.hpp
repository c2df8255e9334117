// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "dynamics/program/emitted_functions.hpp"
#include "dynamics/program/program.hpp"

namespace mixloop {

/// A program's machine code on several states at once (SIMD), for sweeps: lane by lane the bits of the
/// scalar one. Each number of psi, psid, input, t and the outputs is `width()` consecutive doubles.
class LaneCode {
 public:
  /// As MachineCode::load; the width is the processor's: 8 with 512-bit vectors, else 4.
  static std::unique_ptr<LaneCode> load(const std::string& key, const std::function<Program()>& trace,
                                        std::string& complaint);

  int width() const { return width_; }
  void set_up(std::span<const double> parameters) noexcept { emitted_.set_up(parameters); }
  void evaluate(const double* psi, const double* psid, const double* input, const double* t,
                double* outputs) noexcept {
    emitted_.evaluate(psi, psid, input, t, outputs);
  }

 private:
  EmittedFunctions<const double*> emitted_;
  int width_ = 4;
};

}  // namespace mixloop
