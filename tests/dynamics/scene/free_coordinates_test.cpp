// SPDX-License-Identifier: MIT
// Independent coordinates without a motor, as a scene tells them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/procedure/singular_mass.hpp"
#include "dynamics/scene/canonical.hpp"
#include "tests/support/bad_input.hpp"

namespace mixloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A trolley, and what hangs below it on a line that is paid out.
std::string hoist(const std::string& motors, const std::string& free, const std::string& home = "{}") {
  return fmt::format(R"(
motors: {}
{}
transforms:
  - {{from: 0, to: trolley, prismatic: x, axis: [1, 0, 0]}}
  - {{from: trolley, to: line, revolute: swing, axis: [0, 1, 0]}}
  - {{from: line, to: load, prismatic: paid, axis: [0, 0, -1]}}
bodies:
  - {{frame: trolley, mass: 2 kg}}
  - {{frame: load, mass: 1 kg, inertia: {{xx: 1, yy: 1, zz: 1}}}}
home: {}
)",
                     motors, free, home);
}

Scene read(const std::string& text, const std::string& file = "free.yaml") {
  return load_scene(parse_document(text, file));
}

std::vector<std::string> names(std::span<const Scene::Independent> coordinates) {
  std::vector<std::string> all;
  for (const auto& coordinate : coordinates) all.push_back(coordinate.name);
  return all;
}

TEST(FreeCoordinates, StandBehindTheMotorsInTheOrderWritten) {
  const Scene scene =
      read(hoist("{x: linear}", "free: [{paid: linear}, swing]", "{paid: 1 m, swing: 90 deg}"));
  EXPECT_THAT(names(scene.independent), ElementsAre("x", "paid", "swing"));
  EXPECT_THAT(names(scene.motors()), ElementsAre("x"));
  EXPECT_EQ(scene.n(), 3);
  EXPECT_EQ(scene.n_u(), 1);
  EXPECT_TRUE(scene.independent[1].linear);
  EXPECT_FALSE(scene.independent[2].linear);
  EXPECT_EQ(scene.home[1], 1);
  EXPECT_NEAR(scene.home[2], 1.5707963, 1e-7);
}

TEST(FreeCoordinates, AreListedAsMotorsAre) {
  const auto canonical = read(hoist("{x: linear}", "free: [{paid: linear}, swing]")).canonical;
  EXPECT_EQ(read(hoist("[{x: linear}]", "free: {paid: linear, swing: rotary}")).canonical, canonical);
  EXPECT_EQ(read(hoist("[{x: linear}]", "free: [{paid: linear}, {swing: rotary}]")).canonical, canonical);
}

// So that no hash of a scene without them has changed.
TEST(FreeCoordinates, AreInTheCanonicalTextAlone) {
  const std::string driven = read(hoist("{x: linear, paid: linear, swing: rotary}", "")).canonical,
                    free = read(hoist("{x: linear}", "free: {paid: linear, swing: rotary}")).canonical;
  EXPECT_THAT(driven, Not(HasSubstr("free")));
  EXPECT_THAT(free, HasSubstr("free linear\nfree rotary\n"));
}

TEST(FreeCoordinates, AreNamedWhereNoInertiaIsAlongThem) {
  const auto refusal = [](const std::string& load) {
    const auto scene = std::make_shared<const Scene>(read(R"(
motors: {x: linear}
free: [swing]
transforms:
  - {from: 0, to: trolley, prismatic: x, axis: [1, 0, 0]}
  - {from: trolley, to: line, revolute: swing, axis: [0, 1, 0]}
bodies: [{frame: trolley, mass: 2 kg}, )" + load + "]"));
    const auto error = input_error([&] { require_inertia(scene, scene->default_parameters()); });
    return error ? error->message : std::string();
  };
  EXPECT_THAT(refusal("{frame: line, mass: 1 kg}"), HasSubstr("free coordinate 'swing' moves no inertia"));
  EXPECT_THAT(refusal("{frame: trolley, mass: 1 kg}"), HasSubstr("no body hangs on free coordinate 'swing'"));
}

class BadFreeCoordinates : public testing::TestWithParam<BadInput> {};

TEST_P(BadFreeCoordinates, AreRefused) {
  expect_refused(GetParam(), [](const std::string& text, const std::string& file) { read(text, file); });
}

INSTANTIATE_TEST_SUITE_P(
    All, BadFreeCoordinates,
    testing::Values(BadInput{"None", hoist("{x: linear, paid: linear, swing: rotary}", "free: @[]"),
                             "wrong_size", "expected the free coordinates' names, from 1 to 61"},
                    BadInput{"Twice", hoist("{x: linear, paid: linear, swing: rotary}", "free: [@swing]"),
                             "doubly_defined", "swing"},
                    BadInput{"Kind", hoist("{x: linear}", "free: [{paid: @lineal}, swing]"), "unknown_value",
                             "the free coordinate's kind is 'lineal'; did you mean 'linear'?"},
                    BadInput{"TwoInOne", hoist("{x: linear}", "free: [@{paid: linear, swing: rotary}]"),
                             "wrong_size", "expected a free coordinate as name: rotary or name: linear"},
                    BadInput{"Time", hoist("{x: linear}", "free: [@t]"), "invalid_name", "'t' is the time"}),
    bad_input_name);

}  // namespace
}  // namespace mixloop
