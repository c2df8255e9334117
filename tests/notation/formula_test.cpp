// SPDX-License-Identifier: MIT
#include "notation/formula.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <locale>
#include <numbers>

#include "notation/document.hpp"
#include "tests/support/bad_input.hpp"

namespace mixloop {
namespace {

/// x and y are symbols 0 and 1 (x an angle, y a length), len = 2 m, two = 2, twice = 2 x, empty otherwise.
const Scope& scope() {
  static const Scope made = [] {
    Scope names;
    names.define_symbol("x", 0, kPure, {});
    names.define_symbol("y", 1, kLength, {});
    for (const auto& [name, text] : {std::pair{"len", "2 m"}, {"two", "2"}, {"twice", "2*x"}})
      names.define_formula(name, parse_formula(*parse_document(text, "names"), "a formula", names), {});
    return names;
  }();
  return made;
}

Formula formula(const std::string& text) {
  return parse_formula(*parse_document(text, "f"), "a formula", scope());
}

double value(const std::string& text, double x = 0, double y = 0) {
  return evaluate<double>(formula(text), [&](int symbol) { return symbol == 0 ? x : y; });
}

constexpr double kPi = std::numbers::pi;

TEST(Formula, ArithmeticBindsAsInMathematics) {
  EXPECT_EQ(value("1 + 2*3"), 7);
  EXPECT_EQ(value("(1 + 2)*3"), 9);
  EXPECT_EQ(value("8 - 4 - 2"), 2);
  EXPECT_EQ(value("8/4/2"), 1);
  EXPECT_EQ(value("-2^2"), -4);
  EXPECT_EQ(value("2^-1"), 0.5);
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("2*-3"), -6);
  EXPECT_EQ(value("+ - + 3"), -3);
  EXPECT_EQ(value("1e3 + 1.5E-1 + .5"), 1000.65);
}

TEST(Formula, EvaluatesItsSymbolsAndNames) {
  EXPECT_EQ(value("((1 + 1/two)/8 * x - y/len) / 8", 16, 4), (1.5 / 8 * 16 - 2) / 8);
  EXPECT_EQ(value("twice + x", 3), 9);
  EXPECT_EQ(value("len + y", 0, 1), 3);
}

TEST(Formula, FunctionsAgreeWithTheLibrary) {
  EXPECT_EQ(value("sin(x)", 0.3), std::sin(0.3));
  EXPECT_EQ(value("cos(x)", 0.3), std::cos(0.3));
  EXPECT_DOUBLE_EQ(value("tan(x)", 0.3), std::tan(0.3));
  EXPECT_DOUBLE_EQ(value("asin(x)", 0.3), std::asin(0.3));
  EXPECT_DOUBLE_EQ(value("acos(x)", -0.3), std::acos(-0.3));
  EXPECT_EQ(value("atan(x)", 0.3), std::atan(0.3));
  EXPECT_EQ(value("atan2(x, -1)", 0.3), std::atan2(0.3, -1));
  EXPECT_EQ(value("sqrt(x)", 0.3), std::sqrt(0.3));
  EXPECT_EQ(value("exp(x)", 0.3), std::exp(0.3));
  EXPECT_EQ(value("log(x)", 0.3), std::log(0.3));
  EXPECT_EQ(value("x^5 + x^-2 + x^0", 2), 32 + 0.25 + 1);
}

TEST(Formula, UnitsGiveSi) {
  EXPECT_DOUBLE_EQ(value("30 cm"), 0.3);
  EXPECT_DOUBLE_EQ(value("180 deg"), kPi);
  EXPECT_DOUBLE_EQ(value("9.81 m/s^2"), 9.81);
  EXPECT_DOUBLE_EQ(value("2 kg m^2"), 2);
  EXPECT_DOUBLE_EQ(value("2 kg.m^2"), 2);
  EXPECT_DOUBLE_EQ(value("3 N cm"), 0.03);
  EXPECT_DOUBLE_EQ(value("400 us"), 4e-4);
  EXPECT_DOUBLE_EQ(value("60 rpm"), 2 * kPi);
  EXPECT_DOUBLE_EQ(value("5cm + 1"), 1.05) << "a bare number counts in the partner's SI unit";
  EXPECT_DOUBLE_EQ(value("two * 1 cm^2"), 2e-4);
  EXPECT_TRUE(formula("5 N m / (2 m)").dimension.same_powers(kForce));
  EXPECT_TRUE(formula("sqrt(y * 3 m)").dimension.same_powers(kLength));
  EXPECT_TRUE(formula("len^3").dimension.same_powers(power(kLength, 3)));
  EXPECT_TRUE(formula("atan2(y, len)").dimension.pure());
  EXPECT_TRUE(formula("3").dimension.open);
}

TEST(Formula, IsFoldedWhereConstant) {
  EXPECT_TRUE(formula("sin(1)^2 + 2 m/len").is_constant());
  EXPECT_EQ(formula("(1 + 2) * x").nodes.size(), 3U);
  EXPECT_TRUE(formula("1 - 1").is_zero());
  EXPECT_FALSE(formula("0 * x").is_constant()) << "zeros are the expression graph's business";
}

TEST(Formula, MayRunOverSeveralLines) { EXPECT_EQ(value("1 +\n  2 *\n  3"), 7); }

TEST(Formula, DegreeTellsAffineFromCurved) {
  const auto of_x = [](int symbol) { return symbol == 0; };
  EXPECT_EQ(degree(formula("y^2 + 1"), of_x), 0);
  EXPECT_EQ(degree(formula("2*x/two - x*y/len + sin(y/len)"), of_x), 1);
  EXPECT_EQ(degree(formula("x^1"), of_x), 1);
  EXPECT_EQ(degree(formula("x^0"), of_x), 0);
  EXPECT_EQ(degree(formula("x*x"), of_x), 2);
  EXPECT_EQ(degree(formula("x^3"), of_x), 2);
  EXPECT_EQ(degree(formula("1/x"), of_x), 2);
  EXPECT_EQ(degree(formula("sin(x)"), of_x), 2);
  EXPECT_EQ(degree(formula("atan2(x, 1)"), of_x), 2);
  EXPECT_TRUE(depends_on(formula("x - x"), of_x)) << "by form, not by value";
}

TEST(Formula, NamesAreFoundOutsideNumbers) {
  EXPECT_EQ(names_in("r1 * (sin(q2) - a_b)/2"), (std::vector<std::string>{"r1", "sin", "q2", "a_b"}));
  EXPECT_EQ(names_in("2e5 + 1.e5 + 3kg.m"), (std::vector<std::string>{}));
  EXPECT_EQ(names_in("2 kg.m^2"), (std::vector<std::string>{"kg"}));
  EXPECT_TRUE(names_in("").empty());
}

/// The decimal comma of half of Europe.
struct Comma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(Formula, KnowsNoLocale) {
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
  const bool has_german = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
  EXPECT_EQ(value("1234.5 + 0.25"), 1234.75);
  EXPECT_EQ(input_error([] { formula("1234,5"); })->code, "invalid_formula");
  if (has_german) std::setlocale(LC_ALL, "C");
  std::locale::global(before);
}

TEST(Scope, NamesHaveOneMeaning) {
  Scope names;
  names.define_symbol("a", 0, kPure, {"f", 3, 5});
  const auto error = input_error([&] { names.define_formula("a", constant_formula(1), {"f", 7, 2}); });
  EXPECT_EQ(error->code, "doubly_defined");
  EXPECT_STREQ(error->what(), "f:7:2: 'a' is defined twice, first at line 3");
}

TEST(Scope, NamesThatMeanSomethingElseAreRefused) {
  for (const char* name : {"", "1a", "a-b", "a b", "\u03c8", "m", "kg", "deg", "sin", "atan2", "pi"})
    EXPECT_EQ(input_error([&] { check_name(name, {"f", 1, 1}); })->code, "invalid_name") << name;
  EXPECT_EQ(input_error([&] { check_name(std::string(65, 'a'), {"f", 1, 1}); })->code, "invalid_name");
  for (const char* name : {"a", "_", "q1", "L1", "sine", "Pi", "t"})
    EXPECT_NO_THROW(check_name(name, {"f", 1, 1})) << name;
}

class RefusedFormula : public testing::TestWithParam<BadInput> {};

TEST_P(RefusedFormula, WithItsPlace) {
  expect_refused(GetParam(), [](const std::string& text, const std::string& file) {
    const NodePtr root = parse_document(text, file);
    parse_formula(root->kind == Node::Kind::mapping ? *root->entries.at(0).value : *root, "a formula",
                  scope());
  });
}

std::string repeated(const std::string& part, int times) {
  std::string text;
  for (int i = 0; i < times; ++i) text += part;
  return text;
}

INSTANTIATE_TEST_SUITE_P(
    Table, RefusedFormula,
    testing::Values(
        BadInput{"List", "@[1, 2]", "wrong_kind", "found a list of 2; expected a formula"},
        BadInput{"Nothing", "a: @\"\"", "invalid_formula", "found the end; expected a value"},
        BadInput{"OperatorAtTheEnd", "1 +@", "invalid_formula", "found the end; expected a value in '1 +'"},
        BadInput{"NoOperator", "x @y", "invalid_formula", "found 'y'; expected an operator"},
        BadInput{"DecimalComma", "1@,5", "invalid_formula", "found ',5'; expected an operator"},
        BadInput{"TwoPoints", "1.2@.3", "invalid_formula", "found '.3'; expected an operator"},
        BadInput{"Underscore", "1@_000", "unknown_unit", "unknown unit '_000'"},
        BadInput{"Hexadecimal", "0@x10", "unknown_unit", "unknown unit 'x10'"},
        BadInput{"NotClosed", "2*(1 + x@", "invalid_formula", "a parenthesis is not closed"},
        BadInput{"NotOpened", "1 + x@)", "invalid_formula", "found ')'; expected an operator"},
        BadInput{"NoArgument", "sin(@)", "invalid_formula", "found ')'; expected a value"},
        BadInput{"NoParenthesis", "sin @x", "invalid_formula", "sin without its parenthesis"},
        BadInput{"OneOfTwo", "atan2(x@)", "invalid_formula", "atan2 takes two values"},
        BadInput{"TwoOfOne", "sin(x@, y)", "invalid_formula", "not closed"},
        BadInput{"Greek", "x + @\u03c8", "invalid_formula", "found '\u03c8'; expected a value"},
        BadInput{"Undefined", "x + @z1", "undefined_symbol",
                 "undefined symbol 'z1'; expected one of 'len', 'twice', 'two', 'x', 'y'"},
        BadInput{"Misspelt", "2*@twise", "undefined_symbol", "did you mean 'twice'?"},
        BadInput{"UndefinedFunction", "@sinh(x)", "undefined_symbol", "undefined symbol 'sinh'"},
        BadInput{"UnknownUnit", "30 @cmm", "unknown_unit", "unknown unit 'cmm'; did you mean 'cm'?"},
        BadInput{"UnitInTheWrongCase", "5 @KG", "unknown_unit", "did you mean 'kg'?"},
        BadInput{"SymbolAsUnit", "2 @x", "unknown_unit", "unknown unit 'x'"},
        BadInput{"Gram", "3 @g", "unknown_unit", "unknown unit 'g'; 1 g is 0.001 kg in '3 g'"},
        BadInput{"Tonne", "3 @t", "unknown_unit", "1 t is 1000 kg"},
        BadInput{"Inch", "3 @in", "unknown_unit", "1 in is 0.0254 m"},
        BadInput{"Millinewtonmetre", "3 @mNm", "unknown_unit", "1 mNm is 0.001 N m"},
        BadInput{"Meganewton", "3 @MN", "unknown_unit", "1 MN is 1000000 N"},
        BadInput{"NoOtherPowerOfTen", "3 @Mm", "unknown_unit", "1 Mm is 1000000 m"},
        BadInput{"NoOtherPowerOfTenInCapitals", "3 @MM", "unknown_unit",
                 "unknown unit 'MM'; expected one of m, cm"},
        BadInput{"Minus", "@\u22125 kg", "invalid_formula", "a minus sign (U+2212); expected '-'"},
        BadInput{"NoBreakSpace", "5@\u00a0kg", "invalid_formula",
                 "a no-break space (U+00A0); expected an ordinary space"},
        BadInput{"MicroSign", "5 @\u00b5m", "invalid_formula", "a micro sign (U+00B5); expected 'u'"},
        BadInput{"DecimalCommaExplained", "0@,5 kg", "invalid_formula",
                 "a number has a decimal point: 0.5, not 0,5"},
        BadInput{"UnitOfUnits", "2 kg @foot", "unknown_unit", "unknown unit 'foot'"},
        BadInput{"LengthPlusMass", "1 m @+ 1 kg", "wrong_dimension",
                 "a length (m) and a mass (kg) cannot be added or subtracted"},
        BadInput{"AngleMinusLength", "x @- y", "wrong_dimension", "cannot be added or subtracted"},
        BadInput{"SineOfALength", "@sin(y)", "wrong_dimension",
                 "a function of a length (m); expected a number or an angle"},
        BadInput{"SidesOfAnAngle", "@atan2(y, x)", "wrong_dimension", "the two sides of one angle"},
        BadInput{"RootOfARoot", "1 + @sqrt(sqrt(y))", "wrong_dimension", "the square root of m^(1/2)"},
        BadInput{"FractionalPower", "x@^0.5", "invalid_formula", "no whole number"},
        BadInput{"SymbolicPower", "x@^y", "invalid_formula", "no whole number"},
        BadInput{"LargePower", "x@^65", "invalid_formula", "no whole number up to 64"},
        BadInput{"PowersOfPowers", "((((y^64)^2)^2)@^2)^2", "wrong_dimension", "a unit's power past 500"},
        BadInput{"TooLarge", "1 + @1e999", "not_finite", "too large or too small"},
        BadInput{"TooSmall", "@1e-999", "not_finite", "too large or too small"},
        BadInput{"Overflow", "1e200@*1e200", "not_finite", "not finite"},
        BadInput{"UnitOverflow", "1e308 @km", "not_finite", "not finite"},
        BadInput{"Nan", "x + @nan", "not_finite", "not finite"},
        BadInput{"YamlNan", "@.NaN", "not_finite", "not finite"},
        BadInput{"YamlInfinity", "-@.inf", "not_finite", "not finite"},
        BadInput{"Infinity", "@Infinity", "not_finite", "not finite"},
        BadInput{"DivisionByZero", "x@/0", "not_finite", "a division by zero"},
        BadInput{"DivisionByAFoldedZero", "1 @/ (two - 2)", "not_finite", "a division by zero"},
        BadInput{"RootOfLessThanNothing", "@sqrt(-1)", "not_finite", "not finite"},
        BadInput{"LogarithmOfNothing", "@log(0)", "not_finite", "not finite"},
        BadInput{"ArcSineOfTwo", "@asin(2)", "not_finite", "not finite"},
        BadInput{"Quoted", "a: 'x + @z1'", "undefined_symbol", "'z1'"},
        BadInput{"DoublyQuoted", "a: \"x + @z1\"", "undefined_symbol", "'z1'"},
        BadInput{"OnTheSecondLine", "a: x +\n   @z1", "undefined_symbol", "'z1'"},
        BadInput{"InABlock", "a: |\n  x +\n  x * 2 + @z1\n", "undefined_symbol", "in 'x + x * 2 + z1 '"},
        BadInput{"Folded", "a: >\n  2 *\n  @z1\n", "undefined_symbol", "'z1'"},
        BadInput{"Anchored", "a: &k 2 * @z1\n", "undefined_symbol", "'z1'"},
        BadInput{"TooDeep", repeated("(", 63) + "(@1" + repeated(")", 64), "too_deep",
                 "nested deeper than 64 levels"},
        BadInput{"TooManySigns", repeated("-", 64) + "@-1", "too_deep", "nested deeper than 64 levels"},
        BadInput{"TooHigh", "x" + repeated("+x", 255) + "@+x", "too_large", "more than 256 levels"},
        BadInput{"LongText", "x + @" + std::string(100'000, 'z'), "undefined_symbol", "zzz...'"}),
    bad_input_name);

TEST(Formula, ConstantsThatDoubleEachOtherAreBounded) {
  Scope names;
  names.define_symbol("c0", 0, kOpen, {});
  std::optional<InputError> refused;
  for (int i = 1; i < 64 && !refused; ++i) {
    try {
      const auto text = fmt::format("c{} + c{}", i - 1, i - 1);
      names.define_formula(fmt::format("c{}", i),
                           parse_formula(*parse_document(text, "f"), "a formula", names), {});
    } catch (const InputError& error) {
      refused = error;
    }
  }
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->code, "too_large");
  EXPECT_NE(refused->message.find("more than 4096 terms"), std::string::npos);
}

TEST(Formula, LongSumsOfNumbersFold) {
  EXPECT_EQ(value("1" + repeated("+1", 100'000)), 100'001);
  EXPECT_EQ(formula("1" + repeated("+1", 100'000)).nodes.size(), 1U);
}

}  // namespace
}  // namespace mixloop
