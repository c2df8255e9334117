// SPDX-License-Identifier: MIT
#include "sweep/work.hpp"

#include <algorithm>

namespace mixloop {

Work::Work(Dispenser dispenser, Keep keep)
    : dispenser_(std::move(dispenser)), keep_(std::move(keep)), total_(dispenser_.total()) {}

Runs Work::taken(int who) {
  Runs runs;
  if (again_.empty()) {
    runs = dispenser_.next();
  } else {
    runs = again_.back();
    again_.pop_back();
  }
  if (runs.count > 0) in_hand_.push_back({who, runs});
  return runs;
}

Runs Work::take(int who) {
  const std::lock_guard lock(mutex_);
  return stopped_ ? Runs() : taken(who);
}

Runs Work::take_or_wait() {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (stopped_ || done_ == total_) return {};
    if (const Runs runs = taken(0); runs.count > 0) return runs;
    changed_.wait(lock);
  }
}

void Work::bring(int who, std::span<const Outcome> outcomes) {
  if (outcomes.empty()) return;
  const std::lock_guard lock(mutex_);
  const auto its = std::ranges::find_if(
      in_hand_, [&](const InHand& one) { return one.who == who && one.runs.first == outcomes.front().run; });
  if (its == in_hand_.end()) return;
  keep_(outcomes);
  done_ += std::ssize(outcomes);
  its->runs = {its->runs.first + std::ssize(outcomes), its->runs.count - std::ssize(outcomes)};
  if (its->runs.count == 0) in_hand_.erase(its);
  if (done_ == total_) changed_.notify_all();
}

std::int64_t Work::lose(int who) {
  const std::lock_guard lock(mutex_);
  std::int64_t lost = 0;
  for (const InHand& one : in_hand_) {
    if (one.who != who) continue;
    lost += one.runs.count;
    again_.push_back(one.runs);
  }
  std::erase_if(in_hand_, [&](const InHand& one) { return one.who == who; });
  changed_.notify_all();
  return lost;
}

void Work::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  changed_.notify_all();
}

bool Work::is_done() const {
  const std::lock_guard lock(mutex_);
  return done_ == total_;
}

std::int64_t Work::done() const {
  const std::lock_guard lock(mutex_);
  return done_;
}

}  // namespace mixloop
