// SPDX-License-Identifier: MIT
#include "loop/record_rows.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "notation/errors.hpp"

namespace mixloop {
namespace {

[[noreturn]] void refuse(std::size_t bytes, const char* why) {
  throw InputError(
      "too_large", {},
      fmt::format("the record takes {:.3g} GB, more than is free in memory, and {} has no room for "
                  "it ({}); expected a shorter run, fewer laps, a lower rate, or TMPDIR on a "
                  "larger disk",
                  1e-9 * static_cast<double>(bytes), RecordRows::folder(), why));
}

/// Of this size, all its blocks taken.
int nameless_file(std::size_t bytes) {
  const int file = ::open(RecordRows::folder().c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file < 0) refuse(bytes, std::strerror(errno));
  if (const int failed = posix_fallocate(file, 0, static_cast<off_t>(bytes)); failed != 0) {
    ::close(file);
    refuse(bytes, std::strerror(failed));
  }
  return file;
}

}  // namespace

RecordRows::RecordRows(std::size_t count, double memory)
    : on_disk_(static_cast<double>(count * sizeof(double)) > memory) {
  const std::size_t bytes = std::max<std::size_t>(count, 1) * sizeof(double);
  const int file = on_disk_ ? nameless_file(bytes) : -1;
  void* at = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, on_disk_ ? MAP_SHARED : MAP_PRIVATE | MAP_ANONYMOUS,
                  file, 0);
  const int failed = errno;
  if (file >= 0) ::close(file);
  if (at == MAP_FAILED) refuse(bytes, std::strerror(failed));
  numbers_ = {static_cast<double*>(at), bytes / sizeof(double)};
  // Touched here, so that no tick waits for a page.
  if (!on_disk_) std::ranges::fill(numbers_, 0.0);
}

RecordRows::~RecordRows() { munmap(numbers_.data(), numbers_.size_bytes()); }

std::string RecordRows::folder() {
  const char* said = std::getenv("TMPDIR");
  return said != nullptr && *said != 0 ? said : "/var/tmp";
}

double RecordRows::free_disk() {
  std::error_code failed;
  const auto space = std::filesystem::space(RecordRows::folder(), failed);
  return failed ? 0 : static_cast<double>(space.available);
}

}  // namespace mixloop
