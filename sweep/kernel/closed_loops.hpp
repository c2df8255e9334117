// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string>

#include "sweep/engine.hpp"

namespace mixloop {

/// Whether a run's closed loop is one that the kernel has: a plant by rk4 without faults, its command held, a
/// law with gains, a path of the end effector and nothing watched beside it. Else why not, in words; empty
/// where it is.
std::string hindrance_in_lanes(const PreparedRun& run);

/// The same on a graphics processor, whose C library has other bits than the processor's.
std::string hindrance_on_device(const PreparedRun& run);

/// Goes through runs of one kind, one after the other, by a library that was built from kernel_source.
/// Throws std::runtime_error where it can't be loaded.
std::vector<Outcome> run_in_library(const std::string& library, std::span<const PreparedRun> runs,
                                    const Telling& telling);

/// Where closed loops run side by side.
enum class LoopDevice : std::uint8_t {
  cpu,   ///< in the processor's vectors, as many as it has lanes
  cuda,  ///< on a graphics processor, a run a thread
};

/// Goes through runs side by side, by code that is compiled once for all that have the same scenes and kind
/// of law; those that have another kind of closed loop, and all where there is no compiler, by
/// run_one_by_one; on a graphics processor what can't go there in lanes. The outcomes are the same to the
/// bit. Threads share it.
///
/// Of each kernel of a graphics processor the first runs are also gone through here, and compared: throws
/// RunFault("other_bits") where they differ, RunFault("no_device") where there is none, and
/// RunFault("missing_part") where nothing compiles for it.
class LaneEngine {
 public:
  explicit LaneEngine(LoopDevice device = LoopDevice::cpu);

  std::vector<Outcome> operator()(std::span<const PreparedRun> runs, const Telling& telling) const;
  /// How many runs it wants at a time.
  std::int64_t batch() const;

 private:
  class Shelf;
  std::shared_ptr<Shelf> shelf_;
};

}  // namespace mixloop
