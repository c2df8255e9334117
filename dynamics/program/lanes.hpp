// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dynamics/program/emitted_functions.hpp"
#include "dynamics/program/program.hpp"

namespace mixloop {

/// As Arguments, with a time a lane.
struct LaneArguments {
  std::span<const double> psi, psid, input, t;
};

/// A program's machine code on several states at once (SIMD), for sweeps: lane by lane the bits of the
/// scalar one. Each number of psi, psid, input, t and the outputs is `width()` consecutive doubles.
class LaneCode {
 public:
  /// As MachineCode::load; the width is the processor's: 8 with 512-bit vectors, else 4.
  static std::unique_ptr<LaneCode> load(const std::string& key, const std::function<Program()>& trace,
                                        std::string& complaint);

  int width() const { return width_; }
  /// What the set-up leaves for evaluations at these parameter values; the same for all lanes.
  std::vector<double> constants(std::span<const double> parameters) const;
  /// Constant, as a Routine: threads share it.
  void run(const LaneArguments& at, std::span<const double> constants, double* outputs) const noexcept {
    emitted_.evaluate()(at.psi.data(), at.psid.data(), at.input.data(), at.t.data(), constants.data(),
                        outputs);
  }

 private:
  EmittedFunctions<const double*> emitted_;
  int width_ = 4;
};

}  // namespace mixloop
