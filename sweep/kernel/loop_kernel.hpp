// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "sweep/kernel/loop_data.hpp"

namespace mixloop {

/// A kernel of closed loops, compiled: its programs' constants, and the loops themselves.
class LoopKernel {
 public:
  using Symbol = std::function<void*(const std::string& name)>;

  /// For so many runs at once, of the processor's; 0: on a graphics processor.
  LoopKernel(const Symbol& symbol, int lanes);

  static constexpr std::array kPrograms = {"plant", "mass", "bias", "hand"};

  std::size_t constants(std::size_t program) const { return constants_[program]; }
  void set_up(std::size_t program, std::span<const double> parameters, double* k) const {
    if (set_up_[program]) set_up_[program](parameters.data(), k);
  }
  /// Throws RunFault("no_device") where a graphics processor can't.
  void run(const mixloop_loop::Common& common, const mixloop_loop::Each& each,
           const mixloop_loop::Told& told) const;

 private:
  using Run = void (*)(const mixloop_loop::Common*, const mixloop_loop::Each*, const mixloop_loop::Told*,
                       int first);
  using RunAll = const char* (*)(const mixloop_loop::Common*, const mixloop_loop::Each*,
                                 const mixloop_loop::Told*);
  using SetUp = void (*)(const double*, double*);
  int lanes_;
  Run run_ = nullptr;
  RunAll run_all_ = nullptr;
  std::array<SetUp, kPrograms.size()> set_up_{};
  std::array<std::size_t, kPrograms.size()> constants_{};
};

}  // namespace mixloop
