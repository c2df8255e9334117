// SPDX-License-Identifier: MIT
#include "view/request_check.hpp"

#include <gtest/gtest.h>

namespace mixloop {
namespace {

TEST(RequestCheck, KnowsItsOwnNamesOnly) {
  for (const char* ours : {"127.0.0.1:7680", "localhost:7680"}) EXPECT_TRUE(host_is_ours(ours, 7680)) << ours;
  for (const char* strange : {"", "127.0.0.1", "127.0.0.1:7681", "localhost:76800", "evil.example:7680",
                              "127.0.0.1:7680.evil", "[::1]:7680", " 127.0.0.1:7680"})
    EXPECT_FALSE(host_is_ours(strange, 7680)) << strange;
}

TEST(RequestCheck, KnowsItsOwnPagesOnly) {
  EXPECT_TRUE(origin_is_ours("http://127.0.0.1:7680", 7680));
  EXPECT_TRUE(origin_is_ours("http://localhost:7680", 7680));
  for (const char* strange : {"", "null", "https://127.0.0.1:7680", "http://evil.example", "127.0.0.1:7680",
                              "http://127.0.0.1:7680/", "http://evil.example#http://127.0.0.1:7680"})
    EXPECT_FALSE(origin_is_ours(strange, 7680)) << strange;
}

}  // namespace
}  // namespace mixloop
