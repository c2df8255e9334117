// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "runtime/bus/receiver.hpp"

namespace mixloop {

/// A message on its way to the file.
struct Kept {
  std::int64_t at_us;
  std::string channel;
  std::vector<std::uint8_t> data;
};

/// Messages that the file has not taken yet: a disk may stand still for a while.
class Backlog {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20;

  void push(const Received& message) {
    const std::lock_guard lock(mutex_);
    if (bytes_ > kMostBytes) return;  // lost, as the gap in the ticks says
    bytes_ += message.data.size() + sizeof(Kept);
    waiting_.push_back(
        {message.at_us, std::string(message.channel), {message.data.begin(), message.data.end()}});
    news_.notify_one();
  }
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    news_.notify_one();
  }
  /// False once it is closed and empty.
  bool pop(Kept& message) {
    std::unique_lock lock(mutex_);
    news_.wait(lock, [this] { return closed_ || !waiting_.empty(); });
    if (waiting_.empty()) return false;
    message = std::move(waiting_.front());
    waiting_.pop_front();
    bytes_ -= message.data.size() + sizeof(Kept);
    return true;
  }

 private:
  std::mutex mutex_;
  std::condition_variable news_;
  std::deque<Kept> waiting_;
  std::size_t bytes_ = 0;
  bool closed_ = false;
};

}  // namespace mixloop
