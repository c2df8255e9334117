// SPDX-License-Identifier: MIT
// Preloaded (LD_PRELOAD) into a process that talks on the bus, it counts heap allocations of all threads
// while the process is in its steady state: from its 100th datagram to the 20th before its last. At exit a
// line with the program's name and the count is added to the file that MIXLOOP_STEADY_ALLOCATIONS names.
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>

// glibc's own names for what is interposed here.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {

constexpr long kFirst = 100;
constexpr long kLast = 20;  // before the last

std::atomic<long> allocations{0};
std::atomic<long> datagrams{0};
long at_first = 0;
long at_latest[kLast];  // a ring: the count at each of the latest datagrams

void at_datagram() {
  const long number = ++datagrams;
  if (number == kFirst) at_first = allocations;
  at_latest[number % kLast] = allocations;
}

struct Report {
  ~Report() {
    const char* file = std::getenv("MIXLOOP_STEADY_ALLOCATIONS");
    if (file == nullptr || datagrams < kFirst + kLast) return;
    const long count = at_latest[(datagrams + 1) % kLast] - at_first;
    char line[128];
    const int size = std::snprintf(line, sizeof line, "%s %ld\n", program_invocation_short_name, count);
    const int fd = open(file, O_WRONLY | O_CREAT | O_APPEND, 0600);
    if (write(fd, line, static_cast<std::size_t>(size)) < 0) std::abort();
    close(fd);
  }
} report;

}  // namespace

extern "C" {

void* malloc(std::size_t size) { return ++allocations, __libc_malloc(size); }
void* calloc(std::size_t count, std::size_t size) { return ++allocations, __libc_calloc(count, size); }
void* realloc(void* block, std::size_t size) { return ++allocations, __libc_realloc(block, size); }
void* memalign(std::size_t alignment, std::size_t size) {
  return ++allocations, __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return ++allocations, __libc_memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  ++allocations;
  *block = __libc_memalign(alignment, size);
  return *block == nullptr ? ENOMEM : 0;
}

ssize_t sendmsg(int fd, const msghdr* message, int flags) {
  static const auto real = reinterpret_cast<decltype(&sendmsg)>(dlsym(RTLD_NEXT, "sendmsg"));
  const ssize_t sent = real(fd, message, flags);
  at_datagram();
  return sent;
}

}  // extern "C"
