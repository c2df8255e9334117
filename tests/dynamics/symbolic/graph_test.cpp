// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dynamics/program/interpreter.hpp"
#include "dynamics/program/short_chains.hpp"
#include "dynamics/symbolic/derivative.hpp"
#include "dynamics/symbolic/expression.hpp"
#include "dynamics/symbolic/polynomial.hpp"

namespace mixloop {
namespace {

class GraphTest : public ::testing::Test {
 protected:
  Expression psi(std::size_t i) const { return Expression::input(Block::psi, i); }
  double value(const Expression& x, std::vector<double> at) {
    const Interpreter interpreter(make_program(graph_, std::vector{x.node()}));
    Evaluator evaluator(interpreter);
    evaluator.set_up({});
    double out = 0.0;
    evaluator.evaluate({.psi = at}, {&out, 1});
    return out;
  }
  OperationCount operations(const Expression& x) {
    return make_program(graph_, std::vector{x.node()}).run_operations();
  }

  Graph graph_;
  Recording recording_{graph_};
};

TEST_F(GraphTest, EqualExpressionsAreOneNode) {
  EXPECT_EQ((psi(0) * psi(1) + psi(2)).node(), (psi(2) + psi(1) * psi(0)).node());
  EXPECT_EQ((psi(0) - psi(1)).node(), (-(psi(1) - psi(0))).node());
  EXPECT_EQ((Expression(2.0) * psi(0)).node(), (psi(0) + psi(0)).node());
}

TEST_F(GraphTest, ADifferenceAndItsOppositeTakeOneOperation) {
  const Expression x = psi(0) - psi(1), y = psi(1) - psi(0);
  EXPECT_EQ(operations(x * y * psi(2) + x).flops(), 4u);  // x, x x, times psi, x - that
  const Expression u = Expression(-2.0) - psi(0), v = psi(0) + Expression(2.0);
  EXPECT_EQ(operations(u * v).flops(), 3u);  // v, v v, its opposite
  EXPECT_EQ(value(u * v, {1.0}), -9.0);
}

// ((a + b) + c) + d, one after the other, becomes (a + b) + (c + d).
TEST_F(GraphTest, LongSumsAreTakenTogetherSideBySide) {
  Expression sum = psi(0) * psi(0), product = psi(0);
  for (std::size_t i = 1; i < 8; ++i) sum -= psi(i) * psi(i), product *= psi(i);
  const Program chained = make_program(graph_, std::vector{sum.node(), product.node()});
  const Program program = with_short_chains(chained);
  EXPECT_EQ(program.run_operations().flops(), chained.run_operations().flops());
  const auto depth = [](const Program& p, NodeId output) {
    std::vector<int> known(p.nodes.size(), 0);
    for (NodeId id = 0; id < p.nodes.size(); ++id)
      for (NodeId x : Operands(p.nodes[id])) known[id] = std::max(known[id], 1 + known[x]);
    return known[output];
  };
  EXPECT_EQ(depth(chained, chained.outputs[0]), 8);
  EXPECT_EQ(depth(program, program.outputs[0]), 4);
  EXPECT_EQ(depth(program, program.outputs[1]), 3);
  const Interpreter interpreter(program);
  Evaluator evaluator(interpreter);
  evaluator.set_up({});
  const std::vector<double> at{9, 1, 2, 1, 2, 1, 2, 1};
  double out[2];
  evaluator.evaluate({.psi = at}, out);
  EXPECT_EQ(out[0], 81.0 - 16.0);
  EXPECT_EQ(out[1], 72.0);
}

TEST_F(GraphTest, ZerosOnesAndNumbersFold) {
  EXPECT_TRUE((psi(0) * Expression(0.0)).is_number());
  EXPECT_EQ((psi(0) * Expression(1.0) + Expression(0.0)).node(), psi(0).node());
  EXPECT_TRUE((psi(0) - psi(0)).is_number());
  EXPECT_EQ(operations(Expression(2.0) * (Expression(3.0) * psi(0))).flops(), 1u);
  EXPECT_EQ((Expression(1.0) + (Expression(2.0) + psi(0))).node(), (psi(0) + Expression(3.0)).node());
}

TEST_F(GraphTest, ABranchOnWhatIsRecordedThrows) {
  EXPECT_THROW((void)(psi(0) < Expression(1.0)), std::logic_error);
}

TEST_F(GraphTest, AnglesThatDifferByAConstantShareOnePair) {
  const Expression x = sin(psi(0)) + cos(psi(0) + Expression(0.5)) * sin(-psi(0) - Expression(1.25));
  EXPECT_EQ(operations(x).sincos, 1u);
  EXPECT_NEAR(value(x, {0.3}), std::sin(0.3) + std::cos(0.8) * std::sin(-1.55), 4e-16);
}

TEST_F(GraphTest, SumsAndDoublesOfAnglesComeFromTheirs) {
  const Expression s = sin(psi(0)), c = cos(psi(1));  // first: they are the ones to come from
  const Expression x = s * c + sin(psi(0) - psi(1)) + cos(Expression(2.0) * psi(0));
  EXPECT_EQ(operations(x).sincos, 2u);
  EXPECT_NEAR(value(x, {0.7, 0.2}), std::sin(0.7) * std::cos(0.2) + std::sin(0.5) + std::cos(1.4), 4e-16);
}

// q3 + (q2 - q3) is q2, though its coefficients went through roundings.
TEST_F(GraphTest, AnglesMergeAcrossRoundedCoefficients) {
  const Expression q2 = psi(0) * Expression(0.1) + psi(1) * Expression(0.7), q3 = psi(0) * Expression(0.3);
  EXPECT_EQ(operations(cos(q2) + cos(q3 + (q2 - q3))).sincos, 1u);
}

TEST_F(GraphTest, AQuarterTurnLeavesNoResidue) {
  EXPECT_EQ(sin(psi(0) + Expression(std::numbers::pi / 2)).node(),
            sin(psi(0) + Expression(std::numbers::pi / 2)).node());
  EXPECT_EQ((sin(psi(0)) + Expression(0.0) * psi(1)).node(), sin(psi(0)).node());
  EXPECT_EQ(cos(psi(0) + Expression(std::numbers::pi / 2)).node(), (-sin(psi(0))).node());
}

TEST_F(GraphTest, SquaresOfSineAndCosineAddToOne) {
  const Expression s = sin(psi(0)), c = cos(psi(0));
  EXPECT_EQ((s * s + c * c).number(), 1.0);
}

TEST_F(GraphTest, ForwardAndReverseDerivativesAgreeWithDifferences) {
  const Expression x = psi(0), y = psi(1);
  const Expression f = sqrt(x * x + exp(y)) * sin(x * y) / (Expression(1.0) + log(x)) + atan2(y, x);
  const std::vector<NodeId> inputs{x.node(), y.node()};
  const std::vector<NodeId> reverse = gradient(graph_, f.node(), inputs);
  const double at[] = {1.3, 0.4}, step = 1e-6;
  for (std::size_t i = 0; i < 2; ++i) {
    std::vector<double> above{at[0], at[1]}, below = above;
    above[i] += step, below[i] -= step;
    const double difference = (value(f, above) - value(f, below)) / (2 * step);
    const NodeId forward =
        tangents(graph_, std::vector{f.node()}, std::vector{inputs[i]}, std::vector{graph_.one()})[0];
    EXPECT_NEAR(value(Expression::of(forward), {at[0], at[1]}), difference, 1e-9);  // error of the difference
    EXPECT_NEAR(value(Expression::of(reverse[i]), {at[0], at[1]}), difference, 1e-9);
  }
}

TEST_F(GraphTest, SubstitutionRewritesWhatDependsOnTheInput) {
  const Expression f = psi(0) * psi(0) + psi(1);
  const NodeId now =
      substituted(graph_, std::vector{f.node()}, std::vector{psi(0).node()}, std::vector{psi(2).node()})[0];
  EXPECT_EQ(now, (psi(2) * psi(2) + psi(1)).node());
}

TEST_F(GraphTest, ThatIsFullTakesNoMoreAndKnowsWhatItHas) {
  Graph graph(5000);
  std::vector<NodeId> numbers;
  EXPECT_THROW(for (int i = 2;; ++i) numbers.push_back(graph.constant(i)), GraphFull);
  EXPECT_EQ(graph.size(), 5000u);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    ASSERT_EQ(graph.constant(static_cast<double>(i + 2)), numbers[i]) << "equal ones are one";
}

TEST_F(GraphTest, OnlyWhatTheOutputsNeedIsInAProgram) {
  const Expression used = psi(0) * psi(1);
  (void)(exp(psi(2)) * used);
  EXPECT_EQ(operations(used).flops(), 1u);
}

TEST_F(GraphTest, WhatDependsOnParametersAloneRunsBeforehand) {
  const Expression mass = Expression::input(Block::parameter, 0);
  const Program program =
      make_program(graph_, std::vector{((mass * mass + Expression(1.0)) * psi(0)).node()});
  EXPECT_EQ(program.set_up_operations().flops(), 2u);
  EXPECT_EQ(program.run_operations().flops(), 1u);
}

// x (2 y + 3) + 5: two products.
TEST_F(GraphTest, HornerTakesTheCommonVariableOut) {
  Polynomial p;
  p.add({1, 1}, 2.0);
  p.add({1, 0}, 3.0);
  p.add({0, 0}, 5.0);
  const Expression x = horner(p, {psi(0), psi(1)});
  EXPECT_EQ(operations(x).mul, 2u);
  EXPECT_EQ(value(x, {2.0, 7.0}), 39.0);
}

}  // namespace
}  // namespace mixloop
