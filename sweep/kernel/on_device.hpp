// SPDX-License-Identifier: MIT
// The closed loops of many runs on a graphics processor, a run a thread: their numbers there and back. This
// text goes into kernels for CUDA, behind the closed loop.
#pragma once

#if defined(__CUDACC__)

#include <stdint.h>

#include <vector>

#include "sweep/kernel/closed_loop.hpp"
#include "sweep/kernel/loop_data.hpp"

namespace mixloop_loop {

// Registers of one thread fill a processor's: more threads in a block would have to share them.
constexpr int kThreads = 64;

template <class Programs>
__global__ void closed_loops(Common common, Each each, Told told) {
  const int run = blockIdx.x * blockDim.x + threadIdx.x;
  if (run < common.runs) Loop<double, Programs>(common, each, told, run).run();
}

/// One piece of the device's memory, on a stream of the calling thread's own, for many arrays.
class DeviceMemory {
 public:
  DeviceMemory() = default;
  DeviceMemory(const DeviceMemory&) = delete;
  DeviceMemory& operator=(const DeviceMemory&) = delete;
  ~DeviceMemory() {
    if (base_ != nullptr) cudaFreeAsync(base_, cudaStreamPerThread);
  }

  /// `to` is an array there with what `from` has; room alone where that is null.
  template <class Number>
  void place(const Number*& to, const Number* from, long long count) {
    arrays_.push_back({(void**)&to, from, nullptr, (size_t)count * sizeof(Number)});
  }
  /// An array there that is fetched into `from` afterwards, where `is_told`.
  void place(double*& to, double* from, long long count, bool is_told) {
    arrays_.push_back({(void**)&to, nullptr, is_told ? from : nullptr, (size_t)count * sizeof(double)});
  }

  const char* put() {
    size_t size = 0;
    for (const Array& array : arrays_) size += padded(array.size);
    if (const char* failure = failed(cudaMallocAsync((void**)&base_, size, cudaStreamPerThread)))
      return failure;
    char* next = base_;
    for (const Array& array : arrays_) {
      *array.to = next;
      next += padded(array.size);
      if (array.from == nullptr) continue;
      if (const char* failure = failed(cudaMemcpyAsync(*array.to, array.from, array.size,
                                                       cudaMemcpyHostToDevice, cudaStreamPerThread)))
        return failure;
    }
    return nullptr;
  }
  const char* fetch() {
    for (const Array& array : arrays_)
      if (array.back != nullptr)
        if (const char* failure = failed(cudaMemcpyAsync(array.back, *array.to, array.size,
                                                         cudaMemcpyDeviceToHost, cudaStreamPerThread)))
          return failure;
    return failed(cudaStreamSynchronize(cudaStreamPerThread));
  }
  static const char* failed(cudaError_t error) {
    return error == cudaSuccess ? nullptr : cudaGetErrorString(error);
  }

 private:
  struct Array {
    void** to;
    const void* from;
    void* back;
    size_t size;
  };
  static size_t padded(size_t size) { return (size + 255) / 256 * 256; }

  std::vector<Array> arrays_;
  char* base_ = nullptr;
};

/// Why it can't, in words; null where all runs are gone through.
template <class Programs>
const char* closed_loops_on_device(const Common& common, const Each& each, const Told& told) {
  constexpr int n = Programs::n, n_u = Programs::n_u;
  const long long runs = common.runs, ticks = common.ticks + 1;
  Common common_there = common;
  Each there = each;
  Told told_there = told;
  DeviceMemory memory;
  memory.place(common_there.references, common.references, ticks * (3 * n_u + 9));
  memory.place(there.psi0, each.psi0, n * runs);
  memory.place(there.kp, each.kp, n_u * runs);
  memory.place(there.kv, each.kv, n_u * runs);
  memory.place(there.torque_limit, each.torque_limit, n_u * runs);
  memory.place(there.error_limit, each.error_limit, runs);
  memory.place(there.delay_ticks, each.delay_ticks, runs);
  memory.place(there.delay_rest, each.delay_rest, runs);
  memory.place(there.plant_constants, each.plant_constants, Programs::plant_constants * runs);
  memory.place(there.mass_constants, each.mass_constants, Programs::mass_constants * runs);
  memory.place(there.bias_constants, each.bias_constants, Programs::bias_constants * runs);
  memory.place(there.hand_constants, each.hand_constants, Programs::hand_constants * runs);
  if constexpr (Programs::drives) memory.place(there.drives, each.drives, kDriveNumbers * n_u * runs);
  if constexpr (Programs::sensors) {
    memory.place(there.sensors, each.sensors, kSensorNumbers * n * runs);
    memory.place(there.sensor_delay, each.sensor_delay, n * runs);
    memory.place(there.velocity_share, each.velocity_share, runs);
    memory.place(there.seeds, each.seeds, runs);
    memory.place(told_there.sensor_ring, told.sensor_ring, told.sensor_ticks * 2 * n * runs, false);
  }
  memory.place(told_there.ticks_recorded, told.ticks_recorded, runs, true);
  memory.place(told_there.most_error, told.most_error, runs, true);
  memory.place(told_there.most_error_tick, told.most_error_tick, runs, true);
  memory.place(told_there.last_error, told.last_error, runs, true);
  memory.place(told_there.squares, told.squares, runs, true);
  memory.place(told_there.errors, told.errors, runs, true);
  memory.place(told_there.settled_tick, told.settled_tick, runs, true);
  memory.place(told_there.most_torque, told.most_torque, n_u * runs, true);
  if (told.trajectory != nullptr)
    memory.place(told_there.trajectory, told.trajectory, ticks * (2 * n + n_u) * runs, true);
  memory.place(told_there.ring, told.ring, told.ring_ticks * n_u * runs, false);
  if (const char* failure = memory.put()) return failure;
  const unsigned blocks = (unsigned)((runs + kThreads - 1) / kThreads);
  closed_loops<Programs><<<blocks, kThreads, 0, cudaStreamPerThread>>>(common_there, there, told_there);
  if (const char* failure = DeviceMemory::failed(cudaGetLastError())) return failure;
  return memory.fetch();
}

}  // namespace mixloop_loop

#endif
