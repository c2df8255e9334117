// SPDX-License-Identifier: MIT
#include "runtime/protocol/config_hash.hpp"

#include <gtest/gtest.h>

namespace mixloop {
namespace {

TEST(ConfigHash, PacksFourPartsInTheirOrder) {
  const ConfigHash hash{.rate = 0xfedc, .mechanism = 0x1234, .path = 0xabcd, .parameters = 0x0001};
  EXPECT_EQ(static_cast<std::uint64_t>(pack(hash)), 0xfedc1234abcd0001U);
  EXPECT_EQ(unpack_config(pack(hash)), hash);
}

TEST(ConfigHash, NamesWhatDiffers) {
  const ConfigHash mine{.rate = 1, .mechanism = 2, .path = 3, .parameters = 4};
  const auto difference = [&mine](auto change) {
    ConfigHash theirs = mine;
    change(theirs);
    return name_difference(pack(mine), pack(theirs));
  };
  EXPECT_EQ(difference([](ConfigHash&) {}), "");
  EXPECT_EQ(difference([](ConfigHash& h) { h.rate = 9; }), "rate");
  EXPECT_EQ(difference([](ConfigHash& h) { h.mechanism = 9, h.parameters = 9; }),
            "mechanism and shared parameters");
  EXPECT_EQ(difference([](ConfigHash& h) { h.rate = 9, h.mechanism = 9, h.path = 9; }),
            "rate, mechanism and path");
}

TEST(ConfigHash, TakesTheFirst16BitsOfSha256) {
  EXPECT_EQ(hash16("abc"), 0xba78);  // FIPS 180-4's example: ba7816bf...
}

}  // namespace
}  // namespace mixloop
