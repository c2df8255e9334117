// SPDX-License-Identifier: MIT
#include "view/traces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace mixloop {
namespace {

using nlohmann::json;

Traces traces_of(const std::vector<float>& errors, std::size_t most = 100) {
  Traces traces(1, most);
  for (std::size_t k = 0; k < errors.size(); ++k)
    traces.add({.t = 0.001 * static_cast<double>(k), .error = errors[k], .tau = {-errors[k]}});
  return traces;
}

json since(const Traces& traces, std::int64_t from, std::size_t most_points = 100) {
  return json::parse(traces.since(from, most_points));
}

TEST(Traces, GivesEachReaderWhatItHasMissed) {
  const Traces traces = traces_of({1, 2, 3, 4});
  EXPECT_EQ(
      since(traces, 1),
      json::parse(R"({"t": [0.001, 0.002, 0.003], "error": [2, 3, 4], "tau": [[-2, -3, -4]], "way": []})"));
  EXPECT_EQ(since(traces, 4), json::parse(R"({"t": [], "error": [], "tau": [[]], "way": []})"));
}

TEST(Traces, KeepsTheLatest) {
  const Traces traces = traces_of({1, 2, 3, 4, 5}, 3);
  EXPECT_EQ(traces.count(), 5);
  EXPECT_EQ(since(traces, 0)["error"], json({3, 4, 5}));
}

// A browser that reads slowly gets fewer points, and every peak.
TEST(Traces, LosesNoPeakToASlowReader) {
  std::vector<float> errors(1000);
  for (std::size_t k = 0; k < errors.size(); ++k) errors[k] = static_cast<float>(k % 7);
  for (const std::size_t peak : {std::size_t{0}, std::size_t{499}, std::size_t{500}, std::size_t{999}}) {
    auto with_peak = errors;
    with_peak[peak] = 100;
    const json seen = since(traces_of(with_peak, 2000), 0, 20);
    ASSERT_EQ(seen["t"].size(), 20u);
    const auto values = seen["error"].get<std::vector<float>>();
    EXPECT_EQ(*std::max_element(values.begin(), values.end()), 100) << peak;
    const auto taus = seen["tau"][0].get<std::vector<float>>();
    EXPECT_EQ(*std::min_element(taus.begin(), taus.end()), -100) << peak;
    EXPECT_TRUE(std::is_sorted(seen["t"].begin(), seen["t"].end()));
  }
}

TEST(Traces, SaysNullWhereNothingIsKnown) {
  EXPECT_EQ(since(traces_of({NAN, 1}), 0)["error"], json::parse("[null, 1]"));
  EXPECT_EQ(since(traces_of({NAN, NAN, NAN, NAN}), 0, 2)["error"], json::parse("[null, null]"));
}

// By hand: of ticks 0 to 9, 4 at most, the last among them: 1, 4, 6, 9.
TEST(Traces, GivesTheWayWithItsEnd) {
  Traces traces(1, 100);
  for (int k = 0; k < 10; ++k)
    traces.add({.t = 0.001 * k, .tau = {0}, .place = {static_cast<float>(k), 0.5F, -2}});
  traces.add({.t = 0.010, .tau = {0}});
  EXPECT_EQ(since(traces, 8)["way"], json({0.008, 8, 0.5, -2, 0.009, 9, 0.5, -2}));
  Traces known(1, 100);
  for (const Trace& tick : traces.all())
    if (!std::isnan(tick.place[0])) known.add(tick);
  const auto way = since(known, 0, 4)["way"].get<std::vector<double>>();
  ASSERT_EQ(way.size(), 16u);
  EXPECT_EQ((std::vector<double>{way[1], way[5], way[9], way[13]}), (std::vector<double>{1, 4, 6, 9}));
}

}  // namespace
}  // namespace mixloop
