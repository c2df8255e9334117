// SPDX-License-Identifier: MIT
#include "notation/long_work.hpp"

#include <utility>

namespace mixloop {
namespace {

// Of the thread that waits for people: others go on, and are ended by their own means.
thread_local WorkWatch* watch = nullptr;
thread_local int uninterrupted = 0;

}  // namespace

WorkWatch::WorkWatch(std::function<bool()> ended, Heard heard)
    : ended_(std::move(ended)), heard_(std::move(heard)) {
  if (watch != nullptr) throw std::logic_error("another WorkWatch looks after this thread's work");
  watch = this;
}

WorkWatch::~WorkWatch() { watch = nullptr; }

void WorkWatch::require() const {
  if (uninterrupted > 0 || !ended_()) return;
  throw Interrupted(what_ == nullptr ? "interrupted" : std::string("interrupted while ") + what_);
}

Uninterrupted::Uninterrupted() { ++uninterrupted; }
Uninterrupted::~Uninterrupted() { --uninterrupted; }

void work_goes_on() {
  if (watch != nullptr) watch->require();
}

void work_goes_on(const char* what, std::int64_t done, std::int64_t of) {
  if (watch == nullptr) return;
  watch->what_ = done < of ? what : nullptr;
  if (watch->heard_) watch->heard_(what, done, of);
  watch->require();
}

}  // namespace mixloop
