// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "dynamics/scene/scene.hpp"

namespace mixloop {

/// What programs a closed loop is made of.
struct KernelParts {
  std::shared_ptr<const Scene> plant, controller;  ///< the controller's idea of the mechanism
  bool feedforward = false;                        ///< its law takes M psidd_d
  bool bias = false;                               ///< and h
  bool sensors = false, drives = false;            ///< there are some that aren't ideal

  /// Equal where the source is.
  std::string key() const;
  /// Of the same scenes at work, which is found at once.
  bool operator==(const KernelParts&) const = default;
};

enum class KernelTarget : std::uint8_t {
  processor,  ///< functions closed_loops_1, _4 and _8 for so many runs at once
  cuda,       ///< a kernel closed_loops, a run a thread, and the same function for the host
};

/// The closed loop (closed_loop.hpp) of these scenes as a C++ file of its own, or as CUDA. Its bits are those
/// of a simulation, compiled without contraction (-ffp-contract=off, -fmad=false).
std::string kernel_source(const KernelParts& parts, KernelTarget target);

}  // namespace mixloop
