// SPDX-License-Identifier: MIT
#include "commands/studies/sweep_progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>

#include "notation/utf8.hpp"

namespace mixloop {
namespace {

using Clock = std::chrono::steady_clock;

/// "40 s", "12 min", "3.5 h".
std::string duration_text(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

ShownSweep::ShownSweep(std::string name, bool quiet, std::string what)
    : name_(std::move(name)),
      what_(std::move(what)),
      quiet_(quiet),
      on_terminal_(isatty(STDERR_FILENO) == 1),
      next_(Clock::now() + (on_terminal_ ? std::chrono::milliseconds(500) : std::chrono::minutes(1))) {}

ShownSweep::~ShownSweep() {
  if (drawn_ && on_terminal_) fmt::print(stderr, "\r\033[K");
}

void ShownSweep::say(const std::string& text) {
  fmt::print(stderr, "{}mixloop: {}\n", drawn_ && on_terminal_ ? "\r\033[K" : "", printable(text));
}

void ShownSweep::at(const SweepProgress& progress, const std::string& more) {
  if (quiet_ || Clock::now() < next_) return;
  next_ = Clock::now() + (on_terminal_ ? std::chrono::milliseconds(200) : std::chrono::minutes(1));
  drawn_ = true;
  const double left = static_cast<double>(progress.of - progress.done) / progress.rate;
  fmt::print(
      stderr, "{}{}: {} of {} {} ({:.0f} %), {:.4g} {}/s{}{}{}", on_terminal_ ? "\r" : "", name_,
      progress.done, progress.of, what_,
      100 * static_cast<double>(progress.done) / static_cast<double>(std::max<std::int64_t>(progress.of, 1)),
      progress.rate, what_, std::isfinite(left) ? ", " + duration_text(left) + " left" : "", more,
      on_terminal_ ? "\033[K" : "\n");
  std::fflush(stderr);
}

}  // namespace mixloop
