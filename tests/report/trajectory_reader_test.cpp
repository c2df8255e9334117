// SPDX-License-Identifier: MIT
#include "report/trajectory_reader.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/support/bad_input.hpp"
#include "tests/support/command.hpp"

namespace mixloop {
namespace {

TEST(TrajectoryReader, FindsColumnsByTheirNames) {
  ScratchFolder folder;
  const auto file = folder.write("t.csv",
                                 "t,psi_1,psi_2,of_tomorrow,tau_2,velocity_y_actual,psi_desired_1\n"
                                 "0,1,2,3,4,5,6\n0.001,1e-3,-2,3,inf,nan,7");
  TrajectoryReader reader(file);
  EXPECT_EQ(reader.sizes().n, 2u);
  std::vector<Tick> ticks;
  reader.read(0, [&](const Tick& tick) { ticks.push_back(tick); });
  ASSERT_EQ(ticks.size(), 2u);
  EXPECT_EQ(ticks[0].psi, (std::vector<double>{1, 2}));
  EXPECT_EQ(ticks[0].tau[1], 4);
  EXPECT_TRUE(std::isnan(ticks[0].tau[0]));
  EXPECT_EQ(ticks[0].actual.velocity[1], 5);
  EXPECT_EQ(ticks[1].k, 1);
  EXPECT_EQ(ticks[1].t, 0.001);
  EXPECT_EQ(ticks[1].psi[0], 1e-3);
  EXPECT_EQ(ticks[1].psi_desired[0], 7);
}

TEST(TrajectoryReader, TellsMotorsFromCoordinates) {
  ScratchFolder folder;
  TrajectoryReader reader(
      folder.write("t.csv", "t,psi_1,psi_2,psid_1,psid_2,tau_1,psi_desired_1\n0,1,2,3,4,5,6\n"));
  EXPECT_EQ(reader.sizes().n, 2u);
  EXPECT_EQ(reader.sizes().n_u, 1u);
  reader.read(0, [](const Tick& tick) {
    EXPECT_EQ(tick.psid, (std::vector<double>{3, 4}));
    EXPECT_EQ(tick.tau, std::vector<double>{5});
    EXPECT_EQ(tick.psi_desired, std::vector<double>{6});
  });
}

class BadTrajectory : public testing::TestWithParam<BadInput> {};

TEST_P(BadTrajectory, IsRefusedWithItsPlace) {
  ScratchFolder folder;
  const auto file = folder.write("t.csv", GetParam().text);
  const auto error = input_error([&] {
    TrajectoryReader reader(file);
    reader.read(0, [](const Tick&) {});
  });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, GetParam().code);
  EXPECT_THAT(std::string(error->what()), testing::HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Cases, BadTrajectory,
    testing::Values(
        BadInput{"empty", "", "cannot_read", "t.csv: is empty"},
        BadInput{"no_header", "1,2,3\n", "not_a_trajectory", "t.csv:1: no header"},
        BadInput{"no_motor", "t,x\n0,0\n", "not_a_trajectory", "t,psi_1"},
        BadInput{"cut_off", "t,psi_1\n0,1\n0.001", "not_a_trajectory", "t.csv:3: no number for t"},
        BadInput{"word", "t,psi_1\n0,one\n", "not_a_trajectory", "t.csv:2: no number for psi_1"},
        BadInput{"too_many", "t,psi_1\n0,1,2\n", "not_a_trajectory", "t.csv:2: no number for psi_1"}),
    bad_input_name);

}  // namespace
}  // namespace mixloop
