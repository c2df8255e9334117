// SPDX-License-Identifier: MIT
#include "report/curves.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace mixloop {
namespace {

using testing::ElementsAre;
using testing::FloatEq;

std::vector<float> points(const Curves& curves, const std::string& name) {
  const auto at = std::find_if(curves.all().begin(), curves.all().end(),
                               [&](const Curves::Curve& curve) { return curve.name == name; });
  if (at == curves.all().end()) throw std::out_of_range(name);
  return at->envelope.points();
}

/// One motor; the path goes along x at 2 m/s, a tick a second.
Tick tick(std::int64_t k, const Eigen::Vector3d& error) {
  Tick tick({.n = 1, .n_u = 1});
  tick.k = k;
  tick.t = static_cast<double>(k);
  tick.desired.position = {2.0 * static_cast<double>(k), 0, 0};
  tick.desired.velocity = {2, 0, 0};
  tick.actual.position = tick.desired.position + error;
  tick.psid = {3};
  tick.tau_applied = {5};
  return tick;
}

TEST(Curves, SplitsTheErrorAlongThePathAndAcrossIt) {
  Curves curves({0, 1, 2}, 1, 8);
  curves.add(tick(0, {0, 0, 0}));
  curves.add(tick(1, {12, 3, 4}));
  EXPECT_THAT(points(curves, "error"), ElementsAre(0, 13));
  EXPECT_THAT(points(curves, "error_along"), ElementsAre(0, 12));
  EXPECT_THAT(points(curves, "error_across"), ElementsAre(0, 5));
  EXPECT_THAT(points(curves, "error_y"), ElementsAre(0, 3));
  EXPECT_THAT(points(curves, "path_length"), ElementsAre(0, 2));
}

TEST(Curves, KeepsThePathsDirectionWhileItRests) {
  Curves curves({0, 1, 2}, 1, 8);
  curves.add(tick(0, {0, 0, 0}));
  Tick rest = tick(0, {-1, 2, 0});
  rest.desired.velocity.setZero();
  curves.add(rest);
  EXPECT_THAT(points(curves, "error_along"), ElementsAre(0, -1));
  EXPECT_THAT(points(curves, "error_across"), ElementsAre(0, 2));
}

TEST(Curves, CountsOnlyTheAxesThatThePathPrescribes) {
  Curves curves({0, 1}, 1, 8);
  curves.add(tick(0, {3, 4, 100}));
  EXPECT_EQ(curves.tracking_error().max, 5);
}

TEST(Curves, MeasuresTheError) {
  Curves curves({0, 1, 2}, 1, 8);
  for (int k = 0; k < 4; ++k) curves.add(tick(k, {k == 2 ? 7.0 : 1.0, 0, 0}));
  const TrackingError error = curves.tracking_error();
  EXPECT_EQ(error.max, 7);
  EXPECT_EQ(error.time_of_max, 2);
  EXPECT_EQ(error.final, 1);
  EXPECT_DOUBLE_EQ(error.rms, std::sqrt((3 * 1 + 49) / 4.0));
}

TEST(Curves, BalancesEnergyAndPower) {
  Curves curves({0, 1, 2}, 10, 8);  // 10 Hz
  for (const auto& [kinetic, potential, work] : {std::array{0.0, 5.0, 0.0}, {1, 6, 3}, {1, 6, 4}}) {
    Tick t = tick(0, {0, 0, 0});
    t.kinetic_energy = kinetic, t.potential_energy = potential, t.work = work;
    curves.add(t);
  }
  EXPECT_THAT(points(curves, "work_lost"), ElementsAre(0, 1, 2));  // of the work 1 J, then 2 J went elsewhere
  const auto power = points(curves, "power"), rate = points(curves, "energy_rate");
  EXPECT_TRUE(std::isnan(power[0]));
  EXPECT_THAT(std::vector(power.begin() + 1, power.end()), ElementsAre(FloatEq(30), FloatEq(10)));
  EXPECT_THAT(std::vector(rate.begin() + 1, rate.end()), ElementsAre(FloatEq(20), FloatEq(0)));
  EXPECT_THAT(points(curves, "motor_power_1"), ElementsAre(15, 15, 15));
}

TEST(Curves, LeavesWhatIsUnknownEmpty) {
  Curves curves({0, 1, 2}, 1, 8);
  Tick unknown({.n = 1, .n_u = 1});
  curves.add(unknown);
  for (const auto& curve : curves.all()) EXPECT_TRUE(curve.envelope.empty()) << curve.name;
  EXPECT_TRUE(std::isnan(curves.tracking_error().max));
}

}  // namespace
}  // namespace mixloop
