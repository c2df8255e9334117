// SPDX-License-Identifier: MIT
// Files that were cut or changed: refused or read, and nothing else.
#include <gtest/gtest.h>

#include <random>

#include "notation/utf8.hpp"
#include "tests/import/robots.hpp"
#include "tests/support/command.hpp"

namespace mixloop {
namespace {

void expect_refused_or_read(const std::string& text, int& refused) {
  try {
    import_urdf(text, "damaged.urdf", {});
  } catch (const InputError& error) {
    ++refused;
    EXPECT_FALSE(error.code.empty());
    EXPECT_EQ(error.place.file, "damaged.urdf");
    EXPECT_FALSE(first_non_text(error.what())) << error.what();
    EXPECT_LT(std::string(error.what()).size(), 2000U);
  }
}

TEST(DamagedFile, CutAnywhereIsRefused) {
  for (const char* name : {"gripper", "panda"}) {
    const std::string text = bytes_of(robot_file(name));
    const std::size_t whole = text.rfind("</robot>") + 8;
    int refused = 0, count = 0;
    for (std::size_t size = 0; size < whole; size += 7, ++count)
      expect_refused_or_read(text.substr(0, size), refused);
    EXPECT_EQ(refused, count);
  }
}

TEST(DamagedFile, WithWordsChangedIsRefusedOrRead) {
  const std::string text = bytes_of(robot_file("gripper"));
  const std::vector<std::string> words = {"",      "<",    ">",           "\"",      "0",       "-1",
                                          "1e308", "nan",  "left finger", "mimic",   "<link/>", "<!--",
                                          "&#10;", "&lt;", "revolute",    "\xc3\xa9"};
  std::mt19937 chance(7);
  int refused = 0;
  for (int i = 0; i < 1500; ++i) {
    std::string damaged = text;
    for (int changes = 0; changes < 1 + i % 3; ++changes)
      damaged.replace(chance() % damaged.size(), chance() % 12, words[chance() % words.size()]);
    SCOPED_TRACE(i);
    expect_refused_or_read(damaged, refused);
  }
  EXPECT_GT(refused, 500);
  EXPECT_LT(refused, 1500);
}

}  // namespace
}  // namespace mixloop
