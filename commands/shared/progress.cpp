// SPDX-License-Identifier: MIT
#include "commands/shared/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

namespace mixloop {

Progress::Progress(std::string name, std::int64_t ticks, double per_unit, std::string unit)
    : name_(std::move(name)),
      ticks_(ticks),
      per_unit_(per_unit),
      unit_(std::move(unit)),
      on_terminal_(isatty(STDERR_FILENO) == 1),
      next_(std::chrono::steady_clock::now() + std::chrono::milliseconds(500)) {}

Progress::~Progress() { clear(); }

void Progress::at(std::int64_t tick) {
  // A look at the clock costs more than a tick of a small robot.
  if (!on_terminal_ || tick % 64 != 0) return;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + std::chrono::milliseconds(200);
  drawn_ = true;
  const double part = ticks_ > 0 ? static_cast<double>(tick) / static_cast<double>(ticks_) : 1;
  if (unit_.empty())
    fmt::print(stderr, "\r{}: {:.0f} %\033[K", name_, 100 * part);
  else
    fmt::print(stderr, "\r{}: {:.3f} of {:.3f} {} ({:.0f} %)\033[K", name_,
               static_cast<double>(tick) / per_unit_, static_cast<double>(ticks_) / per_unit_, unit_,
               100 * part);
  std::fflush(stderr);
}

void ShownWork::hear(const char* what, std::int64_t done, std::int64_t of) {
  if (done >= of) return progress_.reset();
  if (!progress_ || what != what_) progress_.emplace(what, of, 1, "");
  what_ = what;
  if (++unheard_ % 8 == 0) progress_->at(done / 64 * 64);
}

void Progress::clear() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
  drawn_ = false;
}

}  // namespace mixloop
