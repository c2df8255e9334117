// SPDX-License-Identifier: MIT
// Error falls at each method's order. In 113-bit floats, so that rounding stays out of sight.
#include <gtest/gtest.h>

#include "integrators/integrator.hpp"
#include "tests/integrators/known_motion.hpp"
#include "tests/oracles/wide.hpp"

namespace mixloop {
namespace {

using oracle::Wide;

template <class Method>
class Order : public testing::Test {
 public:
  /// The largest error of (q, v) after t = 1, `count` steps; of the rest too where the method moves it.
  static double error_after(int count) {
    Method method(KnownMotion<Wide>::kN, KnownMotion<Wide>::kSize);
    Vec<Wide> x = KnownMotion<Wide>::at(Wide(0));
    const Wide h = Wide(1) / count;
    method.begin();
    for (int i = 0; i < count; ++i) step_known(method, Wide(h * i), h, x);
    const Vec<Wide> error = (x - KnownMotion<Wide>::at(Wide(1))).cwiseAbs();
    constexpr bool moves_the_rest = !requires { Method::Table::kGamma; };
    return static_cast<double>(error.head(moves_the_rest ? 7 : 6).maxCoeff());
  }
};

using Methods =
    testing::Types<SemiImplicitEuler<Wide>, Leapfrog<Wide>, Rk4<Wide>, DormandPrince<Wide>, Dop853<Wide>,
                   Gauss<Wide, 2>, Gauss<Wide, 4>, Gauss<Wide, 5>, Rodas3<Wide>, Rodas4<Wide>>;
TYPED_TEST_SUITE(Order, Methods);

template <class Method>
constexpr int kOrderOf = [] {
  if constexpr (requires { Method::kOrder; })
    return Method::kOrder;
  else
    return 0;
}();
template <>
constexpr int kOrderOf<SemiImplicitEuler<Wide>> = 1;
template <>
constexpr int kOrderOf<Leapfrog<Wide>> = 2;
template <>
constexpr int kOrderOf<Rk4<Wide>> = 4;

TYPED_TEST(Order, IsWhatItSays) {
  // Past order 8 few steps reach the rounding of 113 bits.
  const int count = kOrderOf<TypeParam> > 8 ? 12 : 256;
  double before = this->error_after(count);
  for (const int times : {2, 4}) {
    const double error = this->error_after(times * count);
    // The error's next term is a share of h of the first: up to a tenth of an order here.
    EXPECT_NEAR(std::log2(before / error), kOrderOf<TypeParam>, times == 2 ? 0.2 : 0.1) << error;
    before = error;
  }
}

// The facts that experiments go by are the methods' own.
TEST(MethodFacts, HaveTheMethodsOrders) {
  EXPECT_EQ(facts(Method::dormand_prince).order, DormandPrince<double>::kOrder);
  EXPECT_EQ(facts(Method::dop853).order, Dop853<double>::kOrder);
  EXPECT_EQ(facts(Method::gauss8).order, (Gauss<double, 4>::kOrder));
  EXPECT_EQ(facts(Method::rodas3).order, Rodas3<double>::kOrder);
  EXPECT_EQ(facts(Method::rodas4).order, Rodas4<double>::kOrder);
  EXPECT_EQ(facts(Method::semi_implicit_euler).order, kOrderOf<SemiImplicitEuler<Wide>>);
  EXPECT_EQ(facts(Method::leapfrog).order, kOrderOf<Leapfrog<Wide>>);
  EXPECT_EQ(facts(Method::rk4).order, kOrderOf<Rk4<Wide>>);
}

}  // namespace
}  // namespace mixloop
