// SPDX-License-Identifier: MIT
// Preloaded (LD_PRELOAD) into processes that talk LCM, it notes when each datagram is sent and received, when
// LCM's pipe wakes the main thread, and when the plant wakes: what bench/critical_path makes its table of. At
// exit the notes go to the file MIXLOOP_PATH_PROBE with the process id appended: CSV of ns (CLOCK_MONOTONIC),
// event, channel, LCM's number.
#include <dlfcn.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

enum class Event : std::uint8_t { send, received, read, wake };
constexpr const char* kNames[] = {"send", "received", "read", "wake"};

struct Note {
  std::int64_t at = 0;
  Event event = Event::send;
  std::uint32_t number = 0;
  char channel[24] = {};
};

constexpr std::size_t kNotes = 1 << 18;
Note notes[kNotes];
std::atomic<std::size_t> used{0};

std::int64_t now() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * std::int64_t{1'000'000'000} + t.tv_nsec;
}

/// `begin`: LCM's header and the channel's name, as far as they are there.
void note(std::int64_t at, Event event, const unsigned char* begin, std::size_t size) {
  const std::size_t slot = used++;
  if (slot >= kNotes) return;
  Note& n = notes[slot];
  n.at = at;
  n.event = event;
  if (size < 9) return;
  n.number =
      std::uint32_t{begin[4]} << 24 | std::uint32_t{begin[5]} << 16 | std::uint32_t{begin[6]} << 8 | begin[7];
  std::memcpy(n.channel, begin + 8, std::min(size - 8, sizeof n.channel - 1));
}

void note_message(std::int64_t at, Event event, const msghdr& message, std::size_t most) {
  unsigned char begin[32];
  std::size_t size = 0;
  for (std::size_t i = 0; i < message.msg_iovlen && size < sizeof begin; ++i) {
    const std::size_t part = std::min({message.msg_iov[i].iov_len, sizeof begin - size, most - size});
    std::memcpy(begin + size, message.msg_iov[i].iov_base, part);
    size += part;
  }
  note(at, event, begin, size);
}

struct Report {
  ~Report() {
    const char* file = std::getenv("MIXLOOP_PATH_PROBE");
    if (file == nullptr || used == 0) return;
    char name[512];
    std::snprintf(name, sizeof name, "%s.%d", file, getpid());
    FILE* out = std::fopen(name, "w");
    if (out == nullptr) return;
    for (std::size_t i = 0; i < std::min<std::size_t>(used, kNotes); ++i)
      std::fprintf(out, "%lld,%s,%s,%u\n", static_cast<long long>(notes[i].at),
                   kNames[static_cast<std::size_t>(notes[i].event)], notes[i].channel, notes[i].number);
    std::fclose(out);
  }
} report;

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

ssize_t sendmsg(int fd, const msghdr* message, int flags) {
  static const auto real = next<decltype(&sendmsg)>("sendmsg");
  note_message(now(), Event::send, *message, SIZE_MAX);
  return real(fd, message, flags);
}

ssize_t recvmsg(int fd, msghdr* message, int flags) {
  static const auto real = next<decltype(&recvmsg)>("recvmsg");
  const ssize_t size = real(fd, message, flags);
  if (size > 0) note_message(now(), Event::received, *message, static_cast<std::size_t>(size));
  return size;
}

ssize_t read(int fd, void* buffer, size_t size) {
  static const auto real = next<decltype(&read)>("read");
  const ssize_t got = real(fd, buffer, size);
  if (size == 1 && got == 1) note(now(), Event::read, nullptr, 0);  // LCM's pipe
  return got;
}

int clock_nanosleep(clockid_t clock, int flags, const timespec* due, timespec* left) {
  static const auto real = next<decltype(&clock_nanosleep)>("clock_nanosleep");
  const int result = real(clock, flags, due, left);
  note(now(), Event::wake, nullptr, 0);
  return result;
}

}  // extern "C"
