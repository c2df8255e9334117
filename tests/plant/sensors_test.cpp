// SPDX-License-Identifier: MIT
#include "plant/sensors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/plant/rig.hpp"

namespace mixloop {
namespace {

constexpr double kSensorRate = 1000;

/// What sensors say of a course psi(k), psid(k), tick by tick.
struct Reading {
  double psi, psid;
  bool stale;
};
template <class Course>
std::vector<Reading> readings(const SensorSettings& settings, int ticks, const Course& course,
                              std::uint64_t seed = 1) {
  const Sensors sensors(settings, seed, 1, kSensorRate);
  Sensors::State memory = sensors.state();
  std::vector<Reading> all;
  for (int k = 0; k < ticks; ++k) {
    const auto [psi, psid] = course(k);
    double psi_out[1], psid_out[1];
    const bool stale =
        sensors.measure(memory, k, std::array{psi}, std::array{psid}, nullptr, psi_out, psid_out);
    all.push_back({psi_out[0], psid_out[0], stale});
  }
  return all;
}

using State = std::array<double, 2>;
State swing(int k) { return {std::sin(0.01 * k), 10 * std::cos(0.01 * k)}; }

TEST(Sensors, SayTheNearestMultipleOfTheirResolution) {
  constexpr double kStep = 2 * std::numbers::pi / 4096;
  const auto said = readings({.resolution = {kStep}}, 1000, swing);
  for (int k = 0; k < 1000; ++k) {
    const double psi = said[k].psi, counts = psi / kStep;
    EXPECT_EQ(psi, kStep * std::round(counts));
    EXPECT_LE(std::abs(psi - swing(k)[0]), kStep / 2 * (1 + 1e-12));
    EXPECT_EQ(said[k].psid, swing(k)[1]) << "the velocity has a sensor of its own";
    EXPECT_FALSE(said[k].stale);
  }
}

TEST(Sensors, AreOffByTheirBias) {
  const auto said = readings({.bias = {-0.25}}, 10, swing);
  for (int k = 0; k < 10; ++k) EXPECT_EQ(said[k].psi, swing(k)[0] - 0.25);
}

// 20,000 draws; each bound is 4.4 standard deviations, missed by one seed in 1e5.
TEST(Sensors, AddNormalNoiseOfTheirStandardDeviation) {
  constexpr int kReadings = 20'000;
  constexpr double kSigma = 1e-3;
  const auto said = readings({.noise = {kSigma}}, kReadings, swing);
  double sum = 0, squares = 0;
  for (int k = 0; k < kReadings; ++k) {
    const double noise = (said[k].psi - swing(k)[0]) / kSigma;
    sum += noise, squares += noise * noise;
  }
  EXPECT_LT(std::abs(sum / kReadings), 4.4 / std::sqrt(kReadings));
  EXPECT_LT(std::abs(squares / kReadings - 1), 4.4 * std::sqrt(2.0 / kReadings));
}

TEST(Sensors, SayWhatWasSoManyTicksAgo) {
  const auto said = readings({.delay = {7}}, 50, swing);
  for (int k = 0; k < 50; ++k) {
    EXPECT_EQ(said[k].psi, swing(std::max(k - 7, 0))[0]);
    EXPECT_EQ(said[k].psid, swing(std::max(k - 7, 0))[1]);
    EXPECT_FALSE(said[k].stale) << "they deliver, late";
  }
}

TEST(Sensors, KeepTheLastReadingWhereOneIsDroppedAndSaySo) {
  constexpr int kReadings = 20'000;
  constexpr double kDrop = 0.1;
  const auto said = readings({.drop = {kDrop}}, kReadings, swing);
  int dropped = 0;
  for (int k = 0; k < kReadings; ++k) {
    dropped += said[k].stale;
    const Reading expected = said[k].stale ? said[k - 1] : Reading{swing(k)[0], swing(k)[1], false};
    ASSERT_EQ(said[k].psi, expected.psi) << k;
    ASSERT_EQ(said[k].psid, expected.psid) << k;
  }
  EXPECT_FALSE(said[0].stale) << "there is none before it";
  EXPECT_LT(std::abs(dropped - kDrop * kReadings), 4.4 * std::sqrt(kDrop * (1 - kDrop) * kReadings));
}

TEST(Sensors, DifferentiateWhatTheyReadOverATick) {
  constexpr double kStep = 0.01;
  const SensorSettings settings{.resolution = {kStep}, .noise = {kStep}, .differentiated = true};
  const auto said = readings(settings, 100, swing);
  EXPECT_EQ(said[0].psid, 0);
  for (int k = 1; k < 100; ++k) EXPECT_EQ(said[k].psid, (said[k].psi - said[k - 1].psi) * kSensorRate);
}

// A first-order low-pass of f answers a ramp of slope v that begins at tick 0 with v (1 - e^(-2 pi f t)).
TEST(Sensors, LowPassTheDifferences) {
  constexpr double kF = 30, kV = 2;
  const auto said = readings({.differentiated = true, .velocity_filter = kF}, 200, [](int k) {
    return State{kV * k / kSensorRate, 77.0};
  });
  for (int k = 0; k < 200; ++k)
    EXPECT_NEAR(said[k].psid, kV * -std::expm1(-2 * std::numbers::pi * kF * k / kSensorRate), 1e-12)
        << k;  // 200 roundings
}

TEST(Sensors, SayTheSameWheneverTheyAreAskedAgain) {
  const SensorSettings settings{.noise = {0.1}, .delay = {2}, .drop = {0.3}, .differentiated = true};
  const Sensors sensors(settings, 5, 1, kSensorRate), others(settings, 6, 1, kSensorRate);
  Sensors::State once = sensors.state(), often = once, other = others.state();
  bool differs = false;
  for (int k = 0; k < 50; ++k) {
    double a[2], b[2], c[2];
    const State now = swing(k);
    const auto ask = [&](const Sensors& of, Sensors::State& memory, double* out) {
      return of.measure(memory, k, {&now[0], 1}, {&now[1], 1}, nullptr, {out, 1}, {out + 1, 1});
    };
    const bool stale = ask(sensors, once, a);
    for (int i = 0; i <= k % 3; ++i) EXPECT_EQ(ask(sensors, often, b), stale);
    EXPECT_EQ(a[0], b[0]);
    EXPECT_EQ(a[1], b[1]);
    ask(others, other, c);
    differs = differs || c[0] != a[0];
  }
  EXPECT_TRUE(differs) << "another seed, other noise";
}

TEST(Sensors, OfAnIdealPlantSayItsState) {
  Plant plant = rig_plant({});
  EXPECT_TRUE(plant.measures_exactly());
  go_on(plant, 10, 1, 2);
  double psi[2], psid[2];
  EXPECT_FALSE(plant.measure(psi, psid));
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(psi[i], plant.psi()[i]);
    EXPECT_EQ(psid[i], plant.psid()[i]);
  }
}

TEST(Sensors, OfAPlantLeaveItsStateAlone) {
  Plant plant = rig_plant({.sensors = {.bias = {1, 2}}});
  EXPECT_FALSE(plant.measures_exactly());
  go_on(plant, 10, 1, 2);
  double psi[2], psid[2];
  plant.measure(psi, psid);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(psi[i], plant.psi()[i] + 1 + i);
}

}  // namespace
}  // namespace mixloop
