// SPDX-License-Identifier: MIT
#include "processes/report_line.hpp"

#include <unistd.h>

#include <cerrno>
#include <cinttypes>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "processes/result_json.hpp"

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

void ReportLine::keeping() const { say(R"({"keeping": true})"); }

void ReportLine::result(const Result& result) const {
  if (fd_ >= 0) say(json_text({{"result", json_of(result)}}));
}

void ReportLine::say(const std::string& line) const {
  if (fd_ < 0) return;
  write_all((line + "\n").data(), line.size() + 1);
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

Reported reported_in(const std::string& line) {
  const auto json = nlohmann::json::parse(line, nullptr, false);
  Reported reported{.keeping = json.contains("keeping")};
  if (json.contains("tick")) reported.tick = json["tick"].get<std::int64_t>();
  if (json.contains("result")) reported.result = result_in(json["result"]);
  return reported;
}

}  // namespace mixloop
