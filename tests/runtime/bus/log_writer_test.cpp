// SPDX-License-Identifier: MIT
#include "runtime/bus/log_writer.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "tests/support/command.hpp"

namespace mixloop {
namespace {

using namespace std::chrono_literals;

/// Says something as often as it can.
class Chatter {
 public:
  explicit Chatter(const char* channel)
      : thread_([this, channel] {
          const std::vector<std::uint8_t> bytes(100);
          while (!over_) bus_.publish(bus_.channel(channel), bytes);
        }) {}
  ~Chatter() {
    over_ = true;
    thread_.join();
  }
  Chatter(const Chatter&) = delete;
  Chatter& operator=(const Chatter&) = delete;

 private:
  Bus bus_;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

TEST(LogWriter, KeepsWhatCameUntilItIsFinished) {
  const ScratchFolder folder;
  Bus bus;
  LogWriter writer({}, folder.file("log"));
  const std::vector<std::uint8_t> bytes(100);
  for (int i = 0; i < 100; ++i) bus.publish(bus.channel("A"), bytes);
  EXPECT_EQ(writer.finish().events, 100);
}

// There is always one more on its way.
TEST(LogWriter, IsFinishedHoweverMuchComes) {
  const ScratchFolder folder;
  const Chatter one("A"), other("B");
  LogWriter writer({}, folder.file("log"));
  std::this_thread::sleep_for(50ms);
  EXPECT_GT(writer.finish().events, 10);
}

}  // namespace
}  // namespace mixloop
