// SPDX-License-Identifier: MIT
// What became of runs stays, whatever ends the process.
#include <gmock/gmock.h>

#include <sys/resource.h>

#include <csignal>
#include <filesystem>

#include "sweep/journal.hpp"
#include "tests/support/command.hpp"
#include "tests/sweep/refused_with.hpp"

namespace mixloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kSweep(64, 'a');

std::vector<Outcome> outcomes(std::int64_t first, std::int64_t count) {
  std::vector<Outcome> all;
  for (std::int64_t run = first; run < first + count; ++run)
    all.push_back({.run = run,
                   .end = run % 2 == 0 ? RunEnd::held : RunEnd::refused,
                   .code = run % 2 == 0 ? "" : "negative_mass",
                   .values = {static_cast<double>(run), 0.1}});
  return all;
}

class Kept : public testing::Test {
 protected:
  std::vector<Outcome> kept(const std::vector<std::filesystem::path>& files) const {
    std::vector<Outcome> all;
    KeptRuns(files, kSweep, 2).each([&](const Outcome& outcome) { all.push_back(outcome); });
    return all;
  }

  ScratchFolder folder;
  std::filesystem::path file = folder.path() / "journal";
};

TEST_F(Kept, RunsComeBackInTheirOrderEachOnce) {
  {
    Journal journal(file, kSweep);
    journal.append(outcomes(4, 4));
    journal.append(outcomes(0, 4));
  }
  Journal(folder.path() / "journal.2-of-2", kSweep).append(outcomes(6, 3));
  EXPECT_EQ(kept({file, folder.path() / "journal.2-of-2"}), outcomes(0, 9));
}

TEST_F(Kept, WhateverIsCutOffOfTheLastRecordTheOthersStayAndMoreCanFollow) {
  { Journal(file, kSweep).append(outcomes(0, 3)); }
  const auto whole = std::filesystem::file_size(file);
  { Journal(file, kSweep).append(outcomes(3, 2)); }
  const auto more = std::filesystem::file_size(file);
  for (auto size = whole; size < more; ++size) {
    std::filesystem::resize_file(file, size);
    EXPECT_EQ(kept({file}), outcomes(0, 3));
    Journal(file, kSweep).append(outcomes(3, 2));
    EXPECT_EQ(std::filesystem::file_size(file), more);
    EXPECT_EQ(kept({file}), outcomes(0, 5));
  }
}

TEST_F(Kept, AFlippedBitEndsWhatIsTrusted) {
  Journal(file, kSweep).append(outcomes(0, 3));
  const auto whole = std::filesystem::file_size(file);
  Journal(file, kSweep).append(outcomes(3, 2));
  std::string bytes = bytes_of(file.string());
  bytes[whole + 40] = static_cast<char>(bytes[whole + 40] ^ 1);
  folder.write("journal", bytes);
  EXPECT_EQ(kept({file}), outcomes(0, 3));
}

TEST_F(Kept, AnotherSweepsIsRefused) {
  { Journal journal(file, kSweep); }
  expect_refused_with("another_sweep", "another sweep", [&] { Journal(file, std::string(64, 'b')); });
  folder.write("journal", "something else");
  expect_refused_with("another_sweep", "another sweep", [&] { Journal(file, kSweep); });
}

// As on a full disk: the file can't grow any more.
TEST_F(Kept, WhereThereIsNoRoomWhatIsThereStaysWhole) {
  std::signal(SIGXFSZ, SIG_IGN);
  Journal journal(file, kSweep);
  journal.append(outcomes(0, 3));
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{std::filesystem::file_size(file) + 10, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  std::string message;
  try {
    journal.append(outcomes(3, 3));
  } catch (const RunFault& fault) {
    EXPECT_EQ(fault.code, "cannot_write");
    message = fault.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_THAT(message, HasSubstr("the same command goes on"));
  EXPECT_EQ(kept({file}), outcomes(0, 3));
  journal.append(outcomes(3, 3));
  EXPECT_EQ(kept({file}), outcomes(0, 6));
}

}  // namespace
}  // namespace mixloop
