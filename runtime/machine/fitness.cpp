// SPDX-License-Identifier: MIT
#include "runtime/machine/fitness.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "notation/errors.hpp"
#include "runtime/bus/multicast_route.hpp"

namespace mixloop {
namespace {

std::string first_line(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

}  // namespace

Finding multicast_finding(const BusOptions& bus) {
  const MulticastGroup group = multicast_group(bus.url);
  try {
    require_multicast_route(group);
    return {"multicast route", "to " + group.address, Fitness::good, ""};
  } catch (const RunFault&) {
    return {"multicast route", "none to " + group.address, Fitness::bad,
            "ip link set lo up; ip route add 224.0.0.0/4 dev lo   (or run under mixloop netns)"};
  }
}

// LCM takes the default size. A datagram of ours occupies some 1.3 kB of it, four are sent a tick.
Finding receive_buffer_finding() {
  constexpr long kWanted = 2 << 20;
  const std::string text = first_line("/proc/sys/net/core/rmem_default");
  const long size = std::atol(text.c_str());
  return {"receive buffer", text + " bytes, " + std::to_string(size / 1300 / 4) + " ticks",
          size >= kWanted ? Fitness::good : Fitness::fair,
          size >= kWanted ? "" : "sysctl -w net.core.rmem_default=" + std::to_string(kWanted)};
}

Finding priority_finding() {
  bool allowed = false;
  std::thread([&] {
    const sched_param parameters{.sched_priority = 80};
    allowed = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
  }).join();
  if (allowed) return {"real-time priority", "SCHED_FIFO 80 allowed", Fitness::good, ""};
  return {"real-time priority", "refused", Fitness::fair,
          "echo '* - rtprio 90' > /etc/security/limits.d/mixloop.conf, then log in again"};
}

Finding locked_memory_finding() {
  constexpr std::size_t kSize = 64 << 20;
  void* memory = mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  const bool locked = memory != MAP_FAILED && mlock(memory, kSize) == 0;
  if (memory != MAP_FAILED) munmap(memory, kSize);
  if (locked) return {"locked memory", "64 MB allowed", Fitness::good, ""};
  return {"locked memory", "64 MB refused", Fitness::fair,
          "echo '* - memlock unlimited' >> /etc/security/limits.d/mixloop.conf, then log in again"};
}

Finding governor_finding() {
  std::set<std::string> governors;
  std::error_code failed;
  for (const auto& cpu : std::filesystem::directory_iterator("/sys/devices/system/cpu", failed))
    if (const std::string governor = first_line(cpu.path() / "cpufreq/scaling_governor"); !governor.empty())
      governors.insert(governor);
  if (governors.empty())
    return {"frequency governor", "not visible, as in a virtual machine", Fitness::good, ""};
  std::string names;
  for (const auto& governor : governors) names += (names.empty() ? "" : ", ") + governor;
  const bool good = governors == std::set<std::string>{"performance"};
  return {
      "frequency governor", names, good ? Fitness::good : Fitness::fair,
      good
          ? ""
          : "for g in /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor; do echo performance > $g; done"};
}

Finding idle_latency_finding() {
  const char* device = "/dev/cpu_dma_latency";
  if (access(device, F_OK) != 0)
    return {"idle states", std::string("no ") + device + ", as in a virtual machine", Fitness::fair,
            "boot with processor.max_cstate=1"};
  const int file = open(device, O_WRONLY | O_CLOEXEC);
  if (file >= 0) close(file);
  if (file >= 0) return {"idle states", std::string(device) + " can be held", Fitness::good, ""};
  return {"idle states", std::string(device) + " can't be opened", Fitness::fair,
          std::string("chmod o+w ") + device};
}

}  // namespace mixloop
