// SPDX-License-Identifier: MIT
// Where a run's numbers lie.
#include "loop/record_rows.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "notation/errors.hpp"

namespace mixloop {
namespace {

/// Resident memory that is no file's, bytes.
double anonymous_memory() {
  std::ifstream statm("/proc/self/statm");
  double size = 0, resident = 0, shared = 0;
  statm >> size >> resident >> shared;
  return (resident - shared) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

TEST(RecordRows, LieInMemoryWhereTheyFit) {
  RecordRows rows(1000, 8000);
  EXPECT_FALSE(rows.on_disk());
  EXPECT_EQ(rows.data()[999], 0);
}

TEST(RecordRows, LieOnDiskWhereTheyDont) {
  constexpr std::size_t kCount = 4 << 20;  // 32 MB
  const double before = anonymous_memory();
  RecordRows rows(kCount, 8.0 * kCount - 1);
  ASSERT_TRUE(rows.on_disk());
  EXPECT_EQ(rows.data()[kCount - 1], 0);
  for (std::size_t i = 0; i < kCount; ++i) rows.data()[i] = static_cast<double>(i);
  double sum = 0;
  for (std::size_t i = 0; i < kCount; ++i) sum += rows.data()[i];
  EXPECT_EQ(sum, 0.5 * kCount * (kCount - 1));
  EXPECT_LT(anonymous_memory() - before, 4e6) << "the kernel may give their pages back";
}

TEST(RecordRows, AreRefusedWhereThereIsNoRoom) {
  const char* said = std::getenv("TMPDIR");
  const std::string before = said != nullptr ? said : "";
  setenv("TMPDIR", "/no/such/folder", 1);
  try {
    RecordRows rows(1000, 0);
    ADD_FAILURE() << "there is no such folder";
  } catch (const InputError& error) {
    EXPECT_EQ(error.code, "too_large");
    EXPECT_THAT(error.message, testing::HasSubstr("/no/such/folder has no room"));
  }
  EXPECT_EQ(RecordRows::free_disk(), 0);
  if (said != nullptr)
    setenv("TMPDIR", before.c_str(), 1);
  else
    unsetenv("TMPDIR");
}

}  // namespace
}  // namespace mixloop
