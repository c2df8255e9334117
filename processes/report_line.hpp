// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

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
  void keeping();
  void result(const nlohmann::json& result);

 private:
  void say(const nlohmann::json& what) const;
  void write_all(const char* text, std::size_t size) const;

  int fd_;  ///< -1: nobody listens
  Instant next_{0};
};

}  // namespace mixloop
