// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

namespace mixloop {

/// Long work was asked to end. Ends a command with exit status 130.
struct Interrupted : std::runtime_error {
  explicit Interrupted(const std::string& message) : std::runtime_error(message) {}
};

/// Looks after the long work of this process (planning, tracing, compiling, reading) while it lives; one at a
/// time. Whoever waits for people has one, and whoever works knows nothing of it.
class WorkWatch {
 public:
  /// How far some work is: `what` it is, a literal, and `done` of `of` steps; all of them when it is over.
  using Heard = std::function<void(const char* what, std::int64_t done, std::int64_t of)>;

  /// `ended`: whether the work is to end.
  explicit WorkWatch(std::function<bool()> ended, Heard heard = {});
  ~WorkWatch();
  WorkWatch(const WorkWatch&) = delete;
  WorkWatch& operator=(const WorkWatch&) = delete;

 private:
  friend void work_goes_on();
  friend void work_goes_on(const char*, std::int64_t, std::int64_t);
  void require() const;

  std::function<bool()> ended_;
  Heard heard_;
  const char* what_ = nullptr;  ///< the latest that was heard of, unless it is over
};

/// While one lives, nothing ends: what is kept of interrupted work is kept whole.
class Uninterrupted {
 public:
  Uninterrupted();
  ~Uninterrupted();
  Uninterrupted(const Uninterrupted&) = delete;
  Uninterrupted& operator=(const Uninterrupted&) = delete;
};

/// Long work calls this at each of its steps, on the thread of the watch. Throws Interrupted where it is to
/// end; costs next to nothing.
void work_goes_on();
/// The same, and tells how far it is.
void work_goes_on(const char* what, std::int64_t done, std::int64_t of);

}  // namespace mixloop
