// SPDX-License-Identifier: MIT
#include "processes/report_line.hpp"

#include <unistd.h>

#include <cerrno>
#include <cinttypes>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace mixloop {

void ReportLine::tick(std::int64_t k) {
  if (fd_ < 0) return;
  const Instant at = now();
  if (at < next_) return;
  next_ = at + std::chrono::milliseconds(100);
  char line[48];
  const int size = std::snprintf(line, sizeof line, "{\"tick\": %" PRId64 "}\n", k);
  write_all(line, static_cast<std::size_t>(size));
}

void ReportLine::keeping() { say({{"keeping", true}}); }

void ReportLine::result(const nlohmann::json& result) { say({{"result", result}}); }

void ReportLine::say(const nlohmann::json& what) const {
  if (fd_ < 0) return;
  const std::string line = what.dump() + "\n";
  write_all(line.data(), line.size());
}

void ReportLine::write_all(const char* text, std::size_t size) const {
  while (size > 0) {
    const ssize_t written = ::write(fd_, text, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;  // nobody listens any more
    text += written;
    size -= static_cast<std::size_t>(written);
  }
}

}  // namespace mixloop
