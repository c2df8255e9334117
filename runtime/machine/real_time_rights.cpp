// SPDX-License-Identifier: MIT
#include "runtime/machine/real_time_rights.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>

namespace mixloop {
namespace {

/// Pages that the stack will need are there.
void prefault_stack() {
  std::array<volatile char, 256 * 1024> stack;
  for (std::size_t at = 0; at < stack.size(); at += 4096) stack[at] = 0;
}

/// Under a finite limit MCL_FUTURE would make later allocations fail: then nothing is locked.
bool lock_memory() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  if (limit.rlim_cur != RLIM_INFINITY && geteuid() != 0) return false;
  mallopt(M_TRIM_THRESHOLD, -1);  // what was given once stays
  mallopt(M_MMAP_MAX, 0);
  prefault_stack();
  return mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
}

template <class Act>
bool for_every_thread(Act act) {
  bool all = true;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task"))
    all = act(static_cast<pid_t>(std::stol(task.path().filename().string()))) && all;
  return all;
}

bool raise_priority(int priority) {
  const sched_param parameters{.sched_priority = priority};
  return for_every_thread(
      [&](pid_t thread) { return sched_setscheduler(thread, SCHED_FIFO, &parameters) == 0; });
}

bool bind_to(int cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(cpu), &set);
  return for_every_thread([&](pid_t thread) { return sched_setaffinity(thread, sizeof set, &set) == 0; });
}

/// Holds as long as the file is open: until the process ends.
bool keep_out_of_idle_states() {
  const int file = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
  if (file < 0) return false;
  const std::int32_t latency = 0;
  return write(file, &latency, sizeof latency) == sizeof latency;
}

}  // namespace

std::vector<std::string> take_real_time_rights(const RealTimeWishes& wishes) {
  std::vector<std::string> lost;
  prctl(PR_SET_TIMERSLACK, 1);  // ns; an ordinary process is woken up to 50 us later than it asked for
  if (!lock_memory())
    lost.emplace_back("memory is not locked: paging may hold up a tick (ulimit -l unlimited)");
  if (wishes.priority > 0 && !raise_priority(wishes.priority))
    lost.emplace_back(
        "no real-time priority: other work may hold up a tick (setcap cap_sys_nice+ep, or run as root)");
  if (wishes.cpu >= 0 && !bind_to(wishes.cpu))
    lost.emplace_back("cannot bind to core " + std::to_string(wishes.cpu));
  if (!keep_out_of_idle_states())
    lost.emplace_back(
        "idle states stay on: wake-ups take about 15 us longer (write access to /dev/cpu_dma_latency)");
  return lost;
}

}  // namespace mixloop
