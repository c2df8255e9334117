// SPDX-License-Identifier: MIT
#include "dynamics/program/processor.hpp"

#include <fstream>

namespace mixloop {
namespace {

std::string read_identity() {
  std::ifstream file("/proc/cpuinfo");
  std::string identity;
  for (std::string line; std::getline(file, line) && !line.empty();)
    if (line.starts_with("model") || line.starts_with("flags") || line.starts_with("CPU part") ||
        line.starts_with("Features"))
      identity += line + '\n';
  return identity;
}

}  // namespace

bool has_fma() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("fma") && __builtin_cpu_supports("avx2");
#else
  return true;  // part of every AArch64
#endif
}

int lane_width() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx512f") ? 8 : 4;
#else
  return 4;
#endif
}

const std::string& processor_identity() {
  static const std::string identity = read_identity();
  return identity;
}

}  // namespace mixloop
