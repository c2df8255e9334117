// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/symbolic/evaluation_angles.hpp"
#include "dynamics/symbolic/harmonic_form.hpp"

namespace mixloop {
namespace {

HarmonicSum product(const HarmonicSum& a, const HarmonicSum& b) {
  HarmonicSum result;
  result.add_product(a, b);
  result.clean();
  return result;
}

TEST(HarmonicSum, SquaresOfSineAndCosineAddToOne) {
  const auto c = HarmonicSum::cosine({1, -2}, 0.3L), s = HarmonicSum::sine({1, -2}, 0.3L);
  HarmonicSum sum = product(c, c);
  sum += product(s, s);
  sum.clean();
  ASSERT_EQ(sum.size(), 1u);
  EXPECT_NEAR(static_cast<double>(sum.terms().begin()->second.value.real()), 1.0, 1e-18);
}

TEST(HarmonicSum, TheDerivativeOfASineIsItsCosine) {
  const HarmonicSpace space{2, {{0.125L, 0}, {0, 0.5L}}};
  HarmonicSum difference = HarmonicSum::sine({3, 0}, 0.2L).derivative(space, 0);
  HarmonicSum expected = HarmonicSum::cosine({3, 0}, 0.2L);
  expected *= 0.375L;
  difference -= expected;
  difference.clean();
  EXPECT_TRUE(difference.is_zero());
}

class PapersRobot : public ::testing::Test {
 protected:
  Graph graph_;
  Recording recording_{graph_};
  HarmonicEnergy energy_ = *harmonic_energy(
      std::make_shared<const Scene>(load_scene(MIXLOOP_SCENES "/mixed_loop_robot.yaml")), graph_);
};

TEST_F(PapersRobot, MassMatrixIsBlockDiagonalInSomeBasisOfRates) {
  const BlockForm form = block_form(energy_, candidate_bases(energy_, 1).at(0));
  EXPECT_EQ(form.blocks.size(), 2u);
}

TEST_F(PapersRobot, ThreeAnglesSayAll) { EXPECT_EQ(evaluation_angles(energy_)->angles.size(), 3u); }

// Gravity is parallel to the first axis: the potential knows nothing of it.
TEST_F(PapersRobot, OnlyThePayloadStaysVariable) { EXPECT_EQ(energy_.atoms.size(), 1u); }

TEST(Harmonic, ConstraintsThatAreNotAffineAreNotItsKind) {
  Graph graph;
  const Recording recording(graph);
  EXPECT_FALSE(harmonic_energy(
      std::make_shared<const Scene>(load_scene(MIXLOOP_SCENES "/spatial_slider_crank.yaml")), graph));
}

}  // namespace
}  // namespace mixloop
