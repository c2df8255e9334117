// SPDX-License-Identifier: MIT
#include "notation/long_work.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace mixloop {
namespace {

TEST(LongWork, GoesOnWhereNobodyLooksAfterIt) {
  EXPECT_NO_THROW(work_goes_on());
  EXPECT_NO_THROW(work_goes_on("counting", 1, 2));
}

TEST(LongWork, IsHeardOfAndEndedByName) {
  bool ended = false;
  std::vector<std::int64_t> heard;
  const WorkWatch watch([&] { return ended; },
                        [&](const char*, std::int64_t done, std::int64_t) { heard.push_back(done); });
  work_goes_on("counting", 1, 3);
  work_goes_on();
  ended = true;
  try {
    work_goes_on("counting", 2, 3);
    FAIL() << "not ended";
  } catch (const Interrupted& interrupted) {
    EXPECT_STREQ(interrupted.what(), "interrupted while counting");
  }
  EXPECT_EQ(heard, (std::vector<std::int64_t>{1, 2}));
}

TEST(LongWork, ThatIsOverIsNotNamed) {
  bool ended = false;
  const WorkWatch watch([&] { return ended; });
  work_goes_on("counting", 3, 3);
  ended = true;
  try {
    work_goes_on();
    FAIL() << "not ended";
  } catch (const Interrupted& interrupted) {
    EXPECT_STREQ(interrupted.what(), "interrupted");
  }
}

TEST(LongWork, KeepsWhatIsKeptWhole) {
  const WorkWatch watch([] { return true; });
  {
    const Uninterrupted whole;
    EXPECT_NO_THROW(work_goes_on());
  }
  EXPECT_THROW(work_goes_on(), Interrupted);
}

TEST(LongWork, OfOtherThreadsIsLeftAlone) {
  const WorkWatch watch([] { return true; });
  std::thread([] { EXPECT_NO_THROW(work_goes_on()); }).join();
}

TEST(LongWork, HasOneWatchAtATime) {
  const WorkWatch watch([] { return false; });
  EXPECT_THROW(WorkWatch([] { return false; }), std::logic_error);
}

}  // namespace
}  // namespace mixloop
