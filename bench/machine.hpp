// SPDX-License-Identifier: MIT
// What a figure was measured on, to print beside it.
#pragma once

#include <fstream>
#include <string>

namespace mixloop::bench {

/// `Intel(R) Xeon(R) Processor, gcc 12.2.0, mixloop 0.1.0`.
inline std::string machine_description() {
  std::string processor = "unknown processor", line;
  std::ifstream cpuinfo("/proc/cpuinfo");
  while (std::getline(cpuinfo, line))
    if (line.rfind("model name", 0) == 0) {
      processor = line.substr(line.find(':') + 2);
      break;
    }
#if defined(__clang__)
  const std::string compiler = "clang " __clang_version__;
#else
  const std::string compiler = "gcc " __VERSION__;
#endif
  return processor + ", " + compiler + ", commit " MIXLOOP_COMMIT;
}

}  // namespace mixloop::bench
