// SPDX-License-Identifier: MIT
#include "loop/origin.hpp"

#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <sys/utsname.h>

#include <Eigen/Core>
#include <fstream>
#include <thread>

namespace mixloop {
namespace {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

}  // namespace

Origin origin_here() {
  utsname system{};
  uname(&system);
  return {
      .mixloop = MIXLOOP_VERSION,
      .compiler = __VERSION__,
      .c_library = gnu_get_libc_version(),
      .eigen = fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION),
      .processor = processor(),
      .kernel = std::string(system.sysname) + " " + system.release,
      .cores = std::thread::hardware_concurrency(),
  };
}

}  // namespace mixloop
