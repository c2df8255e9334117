// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "integrators/integrator.hpp"
#include "tests/integrators/known_motion.hpp"

namespace mixloop {
namespace {

class Stages : public testing::TestWithParam<MethodFacts> {
 protected:
  struct Call {
    int step, stage;
    double t;
  };
  std::vector<Call> calls_of(Vector& x, int substeps, double length) {
    std::vector<Call> calls;
    Integrator integrator({GetParam().method, substeps, 0}, 3, 7);
    advance(integrator, x, length, &calls);
    return calls;
  }
  static void advance(Integrator<>& integrator, Vector& x, double length, std::vector<Call>* calls) {
    integrator.advance(
        x, length,
        [&](int step, int stage, double t, const Vector& at, Vector& dx) {
          if (calls) calls->push_back({step, stage, t});
          KnownMotion<double>::rate(t, at, dx);
        },
        [](double t, const Vector& at, auto& J) { KnownMotion<double>::linearise(t, at, J); });
  }
};

// What is tabulated for a stage is tabulated at its time.
TEST_P(Stages, StandAtTheTimesOfTheirRows) {
  Vector x = KnownMotion<double>::at(0);
  const StageRows rows = stage_rows(GetParam().method);
  const auto calls = calls_of(x, 2, 1.0);
  ASSERT_FALSE(calls.empty());
  for (const auto& [step, stage, t] : calls) {
    const int row = rows.row[static_cast<std::size_t>(stage)];
    const double within = row == rows.rows ? 1 : rows.at[static_cast<std::size_t>(row)];
    EXPECT_DOUBLE_EQ(t, (step + within) / 2);
  }
  EXPECT_EQ(rows.at.front(), 0);
}

TEST_P(Stages, AreAsManyAsTheFactsSay) {
  Vector x = KnownMotion<double>::at(0);
  if (GetParam().method == Method::gauss8) {
    // It iterates: whole sweeps of four, after one look where the piece starts.
    const std::size_t calls = calls_of(x, 5, 1.0).size();
    EXPECT_EQ(calls % 4, 1U);
    EXPECT_GT(calls, 5 * 4 * 3U);
    return;
  }
  const int first = GetParam().method == Method::leapfrog ? 1 : 0;  // its piece's first step looks twice
  EXPECT_EQ(calls_of(x, 5, 1.0).size(), static_cast<std::size_t>(5 * GetParam().evaluations + first));
}

// The same state and piece give the same bytes, whatever went before.
TEST_P(Stages, StartEachPieceAfresh) {
  Integrator used({GetParam().method, 3, 0}, 3, 7), fresh = used;
  Vector other = KnownMotion<double>::at(0.7);
  advance(used, other, 0.3, nullptr);
  Vector a = KnownMotion<double>::at(0.1), b = a;
  advance(used, a, 0.2, nullptr);
  advance(fresh, b, 0.2, nullptr);
  EXPECT_TRUE(a == b);
}

INSTANTIATE_TEST_SUITE_P(All, Stages, testing::ValuesIn(all_methods()),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(MethodNames, AreTheWordsOfExperiments) {
  EXPECT_EQ(method_names(),
            (std::vector<std::string>{"semi_implicit_euler", "leapfrog", "rk4", "dormand_prince", "dop853",
                                      "gauss8", "rodas3", "rodas4"}));
  for (const MethodFacts& method : all_methods()) EXPECT_EQ(&facts(method.method), &method);
}

}  // namespace
}  // namespace mixloop
