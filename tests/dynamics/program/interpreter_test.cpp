// SPDX-License-Identifier: MIT
#include "dynamics/program/interpreter.hpp"

#include <gtest/gtest.h>

#include "dynamics/symbolic/graph.hpp"

namespace mixloop {
namespace {

class InterpreterTest : public ::testing::Test {
 protected:
  NodeId psi(std::size_t i) { return graph_.input(Block::psi, i); }

  std::vector<double> outputs(const std::vector<NodeId>& of, const std::vector<double>& psi) {
    const Interpreter interpreter(make_program(graph_, of));
    Evaluator evaluator(interpreter);
    evaluator.set_up({});
    std::vector<double> outputs(of.size());
    evaluator.evaluate({.psi = psi}, outputs);
    return outputs;
  }

  Graph graph_;
};

TEST_F(InterpreterTest, AProductIsTakenIntoTheOneFusedOperationThatNeedsIt) {
  const NodeId product = graph_.binary(Op::mul, psi(2), psi(3));
  const NodeId sum = graph_.fused(Op::fma, psi(0), psi(1), product);
  const NodeId difference = graph_.fused(Op::fms, psi(0), psi(1), product);
  const Tape alone = make_tape(make_program(graph_, std::vector{sum}));
  ASSERT_EQ(alone.run.runs.size(), 1u);
  EXPECT_TRUE(alone.run.runs[0].kind.of_product);
  EXPECT_EQ(make_tape(make_program(graph_, std::vector{sum, difference})).run.runs.size(), 3u);
  EXPECT_EQ(outputs({sum}, {2, 3, 4, 5}), (std::vector<double>{26}));
  EXPECT_EQ(outputs({sum, difference}, {2, 3, 4, 5}), (std::vector<double>{26, -14}));
  EXPECT_EQ(outputs({sum, product}, {2, 3, 4, 5}), (std::vector<double>{26, 20}));
  EXPECT_EQ(outputs({graph_.fused(Op::fnma, psi(0), psi(1), product)}, {2, 3, 4, 5}),
            (std::vector<double>{14}));
}

TEST_F(InterpreterTest, LongRunsOfOneKindMayWaitForTheirOwnResults) {
  std::vector<NodeId> sums{psi(0)};
  for (std::size_t i = 1; i < 20; ++i) sums.push_back(graph_.binary(Op::sub, psi(i), sums.back()));
  const std::vector<double> ones(20, 1.0);
  const std::vector<double> found = outputs(sums, ones);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i], i % 2 == 0 ? 1.0 : 0.0) << i;
}

TEST_F(InterpreterTest, SinesOfSinesWaitForThem) {
  std::vector<NodeId> sines;
  std::vector<double> expected, at;
  for (std::size_t i = 0; i < 6; ++i) {
    at.push_back(1.0 + static_cast<double>(i) * 1e6);
    double value = at.back();
    NodeId sine = psi(i);
    for (std::size_t depth = 0; depth <= i; ++depth) {
      sine = graph_.unary(Op::sin, sine);
      sines.push_back(sine);
      expected.push_back(value = mixloop_functions::sin(value));
    }
  }
  EXPECT_EQ(outputs(sines, at), expected);
}

}  // namespace
}  // namespace mixloop
