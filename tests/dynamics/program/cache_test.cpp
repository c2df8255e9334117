// SPDX-License-Identifier: MIT
#include "dynamics/program/cache.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>
#include <cstdlib>
#include <fstream>

#include "tests/support/command.hpp"

namespace mixloop::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A cache of the test's own, two directories deep, with one entry.
class CacheTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ::setenv("MIXLOOP_CACHE", cache().c_str(), 1);
    std::string complaint;
    ASSERT_TRUE(cache_directory(complaint)) << complaint;
    std::ofstream(directory_ / "built") << "what was built";
    ASSERT_TRUE(kept().adopt(directory_ / "built"));
  }
  void TearDown() override { ::unsetenv("MIXLOOP_CACHE"); }

  fs::path cache() const { return directory_ / "above" / "cache"; }
  CacheEntry kept() const { return CacheEntry(cache(), "key"); }
  static std::string complaint() {
    std::string complaint;
    EXPECT_FALSE(cache_directory(complaint));
    return complaint;
  }
  static std::string bytes_in(const Descriptor& file) {
    std::string bytes(100, '\0');
    bytes.resize(static_cast<std::size_t>(::pread(file.get(), bytes.data(), bytes.size(), 0)));
    return bytes;
  }

  const ScratchFolder folder_;
  const fs::path& directory_ = folder_.path();
};

TEST_F(CacheTest, GivesTheBytesThatItLookedAt) {
  const Descriptor sound = kept().sound();
  std::ofstream(kept().path()) << "what another put there";
  EXPECT_EQ(bytes_in(sound), "what was built");
  EXPECT_EQ(::pwrite(sound.get(), "x", 1, 0), -1) << "it can be changed still";
  EXPECT_FALSE(kept().sound());
}

TEST_F(CacheTest, TakesNoEntryMadeForAnotherKey) {
  EXPECT_TRUE(kept().sound());
  fs::copy_file(kept().path(), cache() / "other.so");
  EXPECT_FALSE(CacheEntry(cache(), "other").sound());
}

TEST_F(CacheTest, TakesNoEntryThatOthersMayWriteAndFollowsNoLink) {
  const fs::path entry = kept().path();
  ASSERT_EQ(::chmod(entry.c_str(), 0722), 0);
  EXPECT_FALSE(kept().sound());
  ASSERT_EQ(::chmod(entry.c_str(), 0700), 0);
  EXPECT_TRUE(kept().sound());
  fs::rename(entry, directory_ / "moved.so");
  fs::create_symlink(directory_ / "moved.so", entry);
  EXPECT_FALSE(kept().sound());
}

TEST_F(CacheTest, UsesNoDirectoryThatOthersMayWriteNorOneBelowSuch) {
  for (const fs::path& open : {cache(), cache().parent_path(), directory_}) {
    for (mode_t mode : {0777, 0720, 0702}) {
      ASSERT_EQ(::chmod(open.c_str(), mode), 0);
      EXPECT_THAT(complaint(), HasSubstr("others may write to " + open.string()));
    }
    ASSERT_EQ(::chmod(open.c_str(), 0700), 0);
  }
  std::string none;
  EXPECT_TRUE(cache_directory(none)) << none;
}

TEST_F(CacheTest, BelowAStickyDirectoryItIsSafe) {
  ASSERT_EQ(::chmod(directory_.c_str(), 01777), 0);
  std::string none;
  EXPECT_TRUE(cache_directory(none)) << none;
}

TEST_F(CacheTest, UsesNoDirectoryOfAnotherUserNorOneBelowSuch) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root gives directories away";
  constexpr uid_t kAnother = 12345;
  for (const fs::path& theirs : {cache(), cache().parent_path(), directory_}) {
    ASSERT_EQ(::chown(theirs.c_str(), kAnother, kAnother), 0);
    EXPECT_THAT(complaint(), HasSubstr(theirs.string() + " belongs to another user (12345)"));
    ASSERT_EQ(::chown(theirs.c_str(), 0, 0), 0);
  }
}

TEST_F(CacheTest, ALinkOnTheWayIsFollowedAndItsPlaceLookedAt) {
  fs::create_directory_symlink(cache().parent_path(), directory_ / "link");
  ::setenv("MIXLOOP_CACHE", (directory_ / "link" / "cache").c_str(), 1);
  std::string none;
  EXPECT_EQ(cache_directory(none), cache()) << none;
  ASSERT_EQ(::chmod(cache().parent_path().c_str(), 0777), 0);
  EXPECT_THAT(complaint(), HasSubstr("others may write to " + cache().parent_path().string()));
}

TEST_F(CacheTest, RemovesTheWorkshopsOfWhomWasKilledAndNoOthers) {
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const Workshop abandoned(cache());
    const bool told = ::write(ready[1], "", 1) == 1;
    ::pause();
    ::_exit(told ? 0 : 1);
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  const auto workshops = [&] {
    return std::count_if(fs::directory_iterator(cache()), fs::directory_iterator(),
                         [](const auto& entry) { return entry.is_directory(); });
  };
  {
    const Workshop mine(cache());
    EXPECT_EQ(workshops(), 2);
  }
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_EQ(workshops(), 1);
  const Workshop mine(cache());
  EXPECT_TRUE(fs::exists(mine.path()));
  EXPECT_EQ(workshops(), 1);
  EXPECT_TRUE(kept().sound());
}

}  // namespace
}  // namespace mixloop::testing
