// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "base/room.h"

const std::string key = "Section/Key";

double
value(const std::string &text, const Point<3> &X = {}, const double t = 0.)
{
  return Expression(key, text).value(X, t);
}

/** What the constructor says about @p text. */
std::string
complaint(const std::string &text, const unsigned int n = 1)
{
  return complaint_of([&] { Expression(key, text, n); });
}



TEST(Expression, EvaluatesInSpaceAndTime)
{
  const Point<3> X(1., 2., 3.);
  EXPECT_DOUBLE_EQ(value("X + 10*Y + 100*Z + 1000*t", X, 4.), 4321.);
  EXPECT_DOUBLE_EQ(value("X^3 * exp(-t)", Point<3>(2., 0., 0.), 1.),
                   8. * std::exp(-1.));
  EXPECT_DOUBLE_EQ(value("log(Y)", X), std::log(2.));
}


TEST(Expression, KnowsConditionsAndConstants)
{
  const Point<3> X(1., 2., 3.);
  EXPECT_EQ(value("if(X < 2, 5, 7)", X), 5.);
  EXPECT_EQ(value("Z <= 0", X), 0.);
  EXPECT_EQ(value("X > 0 && Y > 2", X), 0.);
  EXPECT_EQ(value("X > 0 || Y > 2", X), 1.);
  EXPECT_EQ(value("(X < 2) * (Y == 2)", X), 1.);
  EXPECT_EQ(value("Z != 3 ? 1 : 2", X), 2.);
  // without blanks, too
  for (const auto &[text, expected] : {std::pair("X<2||Y<1", 1.),
                                       std::pair("X<1||Y<1", 0.),
                                       std::pair("X<2&&Y<3", 1.),
                                       std::pair("X<2&&-Y<-3", 0.),
                                       std::pair("(X<2)||(Y<1)&&Z", 1.),
                                       std::pair("X<1||Y<1|| Z==3", 1.)})
    EXPECT_EQ(value(text, X), expected) << text;
  EXPECT_DOUBLE_EQ(value("cos(pi)"), -1.);
  EXPECT_DOUBLE_EQ(value("_e"), std::exp(1.));
}


TEST(Expression, KnowsFunctionsOfBiology)
{
  EXPECT_DOUBLE_EQ(value("hill(2, 2, 4)"), 0.5);
  EXPECT_DOUBLE_EQ(value("hill(6, 2, 1)"), 0.75);
  EXPECT_EQ(value("hill(-1, 2, 2)"), 0.);
  EXPECT_EQ(value("ramp(1, 2, 4)"), 0.);
  EXPECT_DOUBLE_EQ(value("ramp(3, 2, 4)"), 0.5);
  EXPECT_EQ(value("ramp (5, 2, 4)"), 1.);
}


TEST(Expression, HasComponents)
{
  const Expression e(key, "X; 2*Y; t", 3);
  const auto       v = e.vector(Point<3>(1., 2., 3.), 4.);
  EXPECT_EQ(v[0], 1.);
  EXPECT_EQ(v[1], 4.);
  EXPECT_EQ(v[2], 4.);
  EXPECT_EQ(e.value(Point<3>(1., 2., 3.), 5., 2), 5.);
}


TEST(Expression, MayHaveTwoOrThreeComponentsInThePlane)
{
  const Point<2> X(1., 2.);
  for (const char *text : {"X; Y", "X; Y; 7*X"})
    {
      const auto v = Expression(key, text, 3, 2).vector(X, 0.);
      EXPECT_EQ(v[0], 1.);
      EXPECT_EQ(v[1], 2.);
    }
  EXPECT_THROW(Expression(key, "X", 3, 2), InputError);
  EXPECT_THROW(Expression(key, "X; Y; X; Y", 3, 2), InputError);
}


TEST(Expression, KnowsNoZInThePlane)
{
  const Point<2> X(1., 2.);
  for (const char *text : {"Z", "X + (Y > 0)*Z", "X <= Z"})
    try
      {
        Expression(key, text).value(X, 0.);
        ADD_FAILURE() << "accepted " << text;
      }
    catch (const InputError &error)
      {
        expect_parts(error.what(),
                     {"Section/Key", text, "without Z in 2-D", "X and Y"});
      }
  // also where only the third component has it, which nobody asks for
  EXPECT_THROW(Expression(key, "0; 0; Z", 3, 2).vector(X, 0.), InputError);
  EXPECT_THROW(Expression(key, "Z").check_dimension(2), InputError);
  EXPECT_NO_THROW(Expression(key, "Z").check_dimension(3));
  EXPECT_NO_THROW(Expression(key, "X; Y; 0", 3, 2).check_dimension(2));
}


TEST(Expression, RecognisesPlainNumbersAndTime)
{
  EXPECT_TRUE(Expression(key, " -1.5e3 ").is_constant());
  EXPECT_TRUE(Expression(key, "0; 1; 2", 3).is_constant());
  EXPECT_EQ(Expression(key, "0; 1; -2", 3).vector(Point<3>(), 1.)[2], -2.);
  EXPECT_TRUE(Expression(key, "3^2; 2*pi", 2).is_constant());
  EXPECT_EQ(*Expression(key, "3^2").number(), 9.);
  EXPECT_FALSE(Expression(key, "0; X; 2", 3).is_constant());
  EXPECT_TRUE(Expression(key, "1 + sin(t)").depends_on_time());
  EXPECT_FALSE(Expression(key, "sqrt(X) + tan(Y)").depends_on_time());
}


TEST(Expression, KnowsWhatIsAlwaysTheSameNumber)
{
  EXPECT_TRUE(Expression(key, "0").is_always(0.));
  EXPECT_TRUE(Expression(key, "1e0").is_always(1.));
  EXPECT_FALSE(Expression(key, "1").is_always(0.));
  EXPECT_FALSE(Expression(key, "0*X").is_always(0.));
  // the components that count
  const Expression upward(key, "0; 0; 1", 3);
  EXPECT_TRUE(upward.is_always(0., 2));
  EXPECT_FALSE(upward.is_always(0., 3));
  // every type counts
  const Expression zero(key, "0");
  EXPECT_TRUE(zero.with_types({{1, Expression(key, "0.0")}}).is_always(0.));
  EXPECT_FALSE(zero.with_types({{1, Expression(key, "2")}}).is_always(0.));
  EXPECT_FALSE(
    Expression(key, "2").with_types({{1, zero}, {2, zero}}).is_always(0.));
}


TEST(Expression, SaysWhereAnErrorIs)
{
  expect_parts(
    complaint("1 + sinn(X)"),
    {"Section/Key", "1 + sinn(X)", "character 5", "sinn", "X, Y, Z"});
  expect_parts(complaint("x + 1"),
               {"character 1", "\"x\"", "Write X", "X, Y, Z"});
  expect_parts(complaint("1 + age"), {"character 5", "\"age\"", "no age"});
  expect_parts(complaint("X; Y; Z +", 3), {"Component 3", "Unexpected end"});
  expect_parts(complaint("(X + 1"), {"Missing parenthesis"});
  expect_parts(complaint("X<1||Y<1||sinn(X)"), {"character 11", "sinn"});
  expect_parts(complaint("X<1||Y<1||"), {"character 11", "Unexpected end"});
}


TEST(Expression, RefusesTheWrongNumberOfComponents)
{
  expect_parts(complaint(""), {"Section/Key", "1 expression", "a number"});
  expect_parts(complaint("  "), {"1 expression", "a number"});
  expect_parts(complaint("X; Y", 3), {"X; Y", "3 expressions", "There are 2"});
  expect_parts(complaint("X; Y"), {"1 expression", "There are 2"});
  expect_parts(complaint("X; ; Y", 3), {"Component 2", "nothing"});
}


TEST(Expression, RefusesWhatWouldBeMisunderstood)
{
  // muParser: 5, 3, 1 and a number that changes with every call
  expect_parts(complaint("1,5"), {"Character 2", "comma", "point"});
  expect_parts(complaint("X = 3"), {"Character 3", "single '='", "=="});
  expect_parts(complaint("0 < X < 5"), {"Character 7", "chain", "&&"});
  expect_parts(complaint("0 < X <= 5 && Y > 0"), {"Character 7", "chain"});
  expect_parts(complaint("X > rand()"), {"Random"});
  // what muParser refuses itself
  for (const char *text : {"X**2",
                           "!(X > 0)",
                           "Y*~X",
                           "X <> 3",
                           "X % 2",
                           "1 + x[0]",
                           "\"X\"",
                           "2*|X|",
                           "Y + 2X",
                           "1.5e-3 (X)"})
    EXPECT_NE(complaint(text), "") << text;
  expect_parts(complaint("sin X"), {"sin(X)"});
  for (const char *text : {"pow(X, 2)",
                           "X >= 3",
                           "X == 3",
                           "X != 3 || Y != 3",
                           "1e3*X + .5E-2 - 12e+1",
                           "X > 0 | Y > 0",
                           "log10(X^2 + 1)",
                           "0 < X && X < 5",
                           "if(X < 1, Y < 2, Z < 3)",
                           "(0 < X) == (X < 5)"})
    EXPECT_EQ(complaint(text), "") << text;
}


TEST(Expression, RefusesValuesThatAreNotFinite)
{
  const Expression e(key, "1/X + log(t)");
  EXPECT_NO_THROW(e.value(Point<3>(1., 0., 0.), 1.));
  for (const auto &[X, t] : {std::pair(0., 1.), std::pair(1., -1.)})
    try
      {
        e.value(Point<3>(X, 5., 6.), t);
        ADD_FAILURE() << "accepted " << X << ", " << t;
      }
    catch (const InputError &error)
      {
        expect_parts(error.what(),
                     {"Section/Key", "1/X + log(t)", "finite", "5 6", "t = "});
      }
  EXPECT_THROW(value("1/0"), InputError);
}


TEST(Expression, CopiesShareTheParser)
{
  std::vector<Expression> copies(3, Expression(key, "2*X"));
  EXPECT_EQ(copies[1].value(Point<3>(4., 0., 0.), 0.), 8.);
  EXPECT_EQ(copies[2].text(), "2*X");
  EXPECT_EQ(copies[2].key(), key);
}


TEST(Expression, HasANormalDistributionOfTheNoise)
{
  const Expression e(key, "normal(3, 2)", 1, 1, {{Variable::noise}});
  EXPECT_EQ(e.used(), std::vector<Variable>{Variable::noise});
  VariableValues values{};
  for (const auto &[noise, value] : {std::pair(0.5, 3.),
                                     std::pair(0.8413447460685429, 5.),
                                     std::pair(0.15865525393145707, 1.)})
    {
      values[static_cast<unsigned int>(Variable::noise)] = noise;
      EXPECT_NEAR(e.value(values), value, 1e-12);
    }
}
