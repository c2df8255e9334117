// SPDX-License-Identifier: MIT
#include "loop/free_memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace mixloop {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

double of_the_machine() {
  std::ifstream info("/proc/meminfo");
  for (std::string name, rest; info >> name; std::getline(info, rest)) {
    double kilobytes = 0;
    if (name == "MemAvailable:" && info >> kilobytes) return 1024 * kilobytes;
  }
  return kUnlimited;
}

/// Empty, "max" and what isn't there are no limit.
double of_the_control_group() {
  double bytes = 0;
  return std::ifstream("/sys/fs/cgroup/memory.max") >> bytes ? bytes : kUnlimited;
}

double of_the_process() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
  double pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return std::max(0.0,
                  static_cast<double>(limit.rlim_cur) - pages * static_cast<double>(sysconf(_SC_PAGESIZE)));
}

}  // namespace

double free_memory() { return std::min({of_the_machine(), of_the_control_group(), of_the_process()}); }

}  // namespace mixloop
