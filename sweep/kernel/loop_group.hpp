// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sweep/engine.hpp"
#include "sweep/kernel/kernel_source.hpp"
#include "sweep/kernel/loop_data.hpp"
#include "sweep/kernel/loop_kernel.hpp"

namespace mixloop {

/// The kernel that a run's closed loop takes.
KernelParts parts_of(const Experiment& experiment);

/// Whether two runs may be gone through by one call of a kernel.
bool are_alike(const PreparedRun& a, const PreparedRun& b);

/// A plan's references, tick by tick, as kernels take them.
std::vector<double> references_of(const Plan& plan);

/// Numbers of runs side by side: number i of run r at [i * runs + r].
class Rows {
 public:
  Rows(std::size_t numbers, std::size_t runs) : runs_(runs), values_(numbers * runs) {}
  double* data() { return values_.data(); }
  double& at(std::size_t i, std::size_t run) { return values_[i * runs_ + run]; }
  template <class Numbers>
  void put(std::size_t run, const Numbers& numbers) {
    std::size_t i = 0;
    for (const double number : numbers) at(i++, run) = number;
  }

 private:
  std::size_t runs_;
  std::vector<double> values_;
};

/// Runs that are alike but for their numbers, gone through by a kernel: these numbers, and what becomes of
/// them.
class LoopGroup {
 public:
  /// `references`: their plan's (references_of).
  LoopGroup(std::span<const PreparedRun* const> runs, const LoopKernel& kernel,
            const std::vector<double>& references, const Telling& telling);

  Measures measures(std::size_t run);

 private:
  std::size_t take(std::size_t run, const LoopKernel& kernel);
  void take_hardware(std::size_t run);
  mixloop_loop::Common common() const;
  mixloop_loop::Each each();
  mixloop_loop::Told told();

  std::span<const PreparedRun* const> runs_;
  const Telling& telling_;
  const Plan& plan_;
  int n_, ring_ticks_ = 0, sensor_ticks_ = 1;
  const std::vector<double>& references_;
  Rows psi0_{0, 0}, kp_{0, 0}, kv_{0, 0}, torque_limit_{0, 0}, most_torque_{0, 0};
  Rows error_limit_{1, runs_.size()}, delay_ticks_{1, runs_.size()}, delay_rest_{1, runs_.size()};
  std::array<Rows, 4> constants_{Rows{0, 0}, Rows{0, 0}, Rows{0, 0}, Rows{0, 0}};
  Rows drives_{0, 0}, sensors_{0, 0}, sensor_delay_{0, 0}, velocity_share_{1, runs_.size()};
  std::vector<unsigned long long> seeds_ = std::vector<unsigned long long>(runs_.size());
  Rows told_{7, runs_.size()}, ring_{0, 0}, sensor_ring_{0, 0}, trajectory_{0, 0};
};

}  // namespace mixloop
