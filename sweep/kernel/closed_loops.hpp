// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string>

#include "sweep/engine.hpp"
#include "sweep/kernel/kernel_source.hpp"

namespace mixloop {

/// Whether a run's closed loop is one that the kernel has: a plant by rk4 without faults, its command held, a
/// law with gains, a path of the end effector and nothing watched beside it. Else why not, in words; empty
/// where it is.
std::string hindrance_in_lanes(const PreparedRun& run);

/// Goes through runs of one kind, one after the other, by a library that was built from kernel_source.
/// Throws std::runtime_error where it can't be loaded.
std::vector<Outcome> run_in_library(const std::string& library, std::span<const PreparedRun> runs,
                                    const Telling& telling);

/// Goes through runs side by side in the processor's vectors, as many as it has lanes, by code that is
/// compiled once for all that have the same scenes and kind of law; those that have another kind of closed
/// loop, and all where there is no compiler, by run_one_by_one. The outcomes are the same to the bit. Threads
/// share it.
class LaneEngine {
 public:
  std::vector<Outcome> operator()(std::span<const PreparedRun> runs, const Telling& telling) const;

 private:
  struct Shelf;
  std::shared_ptr<Shelf> shelf_ = make_shelf();
  static std::shared_ptr<Shelf> make_shelf();
};

}  // namespace mixloop
