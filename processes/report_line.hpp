// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "loop/result.hpp"
#include "runtime/clock/clock.hpp"

namespace mixloop {

/// What a plant that was launched by `mixloop run` tells it over a pipe, a JSON object a line: {"tick": k}
/// now and then, {"keeping": true} before results are written, {"result": {...}} once. Without a pipe nothing
/// is said.
class ReportLine {
 public:
  explicit ReportLine(int fd) : fd_(fd) {}

  /// Ten times a second at most; allocates nothing.
  void tick(std::int64_t k);
  void keeping() const;
  void result(const Result& result) const;

 private:
  void say(const std::string& line) const;
  void write_all(const char* text, std::size_t size) const;

  int fd_;  ///< -1: nobody listens
  Instant next_{0};
};

/// A line of it read back, one of the three.
struct Reported {
  std::optional<std::int64_t> tick;
  bool keeping = false;
  std::optional<Result> result;
};
Reported reported_in(const std::string& line);

}  // namespace mixloop
