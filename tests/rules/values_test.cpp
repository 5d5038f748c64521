// Values as text, and the built-in functions.
#include <gtest/gtest.h>

#include <array>

#include "grammar/rules/color.h"
#include "grammar/rules/evaluate.h"
#include "grammar/rules/value.h"
#include "modeler/core/conventions.h"

namespace sgm::rules {
namespace {

Value apply(Fn fn, std::initializer_list<Value> args) { return applyFunction(fn, std::vector<Value>(args)); }
Value vec(double a, double b, double c) {
    return tuple(std::array{Value::number(a), Value::number(b), Value::number(c)});
}
Value axis(int n) {
    Value v;
    v.kind = Value::Kind::Axis;
    v.n[0] = n;
    return v;
}

TEST(ValueText, IsWhatAGrammarWrites) {
    EXPECT_EQ(toText(Value::number(1.2, Unit::Metre)), "1.2m");
    EXPECT_EQ(toText(Value::number(radians(12), Unit::Angle)), "12deg");
    EXPECT_EQ(toText(Value::number(.3, Unit::Share)), "30%");
    EXPECT_EQ(toText(Value::number(2.2, Unit::PerMetre)), "2.2/m");
    EXPECT_EQ(toText(Value::number(420, Unit::SquareMetre)), "420m2");
    EXPECT_EQ(toText(Value::number(.5, Unit::CubicMetre)), "0.5m3");
    EXPECT_EQ(toText(Value::number(-0.0)), "0");
    EXPECT_EQ(toText(vec(1, 2, 3)), "(1, 2, 3)");
    EXPECT_EQ(toText(Value::boolean(true)), "true");
    EXPECT_EQ(toText(axis(3)), "-y");
    EXPECT_EQ(toText(axis(6)), "centre");
}

TEST(Colors, SurviveTheWayToLinearAndBack) {
    for (uint32_t byte = 0; byte < 256; ++byte) {
        const uint32_t hex = byte << 16 | (255 - byte) << 8 | (byte ^ 0x5a);
        EXPECT_EQ(hexFromLinear(linearFromHex(hex)), hex);
    }
    EXPECT_NEAR(linearFromSrgb(.5), .2140, 1e-4);
}

TEST(Functions, CarryUnits) {
    const Value metre = Value::number(6, Unit::Metre), other = Value::number(2, Unit::Metre), plain = Value::number(3);
    EXPECT_EQ(apply(Fn::Add, {metre, plain}), Value::number(9, Unit::Metre));
    EXPECT_EQ(apply(Fn::Mul, {plain, metre}), Value::number(18, Unit::Metre));
    EXPECT_EQ(apply(Fn::Div, {metre, other}), Value::number(3));
    EXPECT_EQ(apply(Fn::Div, {plain, other}).units[0], Unit::PerMetre);
    EXPECT_EQ(apply(Fn::Mul, {Value::number(.5, Unit::Share), metre}), Value::number(3, Unit::Metre));
    EXPECT_EQ(apply(Fn::Mul, {other, Value::number(2, Unit::PerMetre)}), Value::number(4));
}

TEST(Functions, MakeAreasAndVolumesOfLengths) {
    const Value length = Value::number(3, Unit::Metre), area = apply(Fn::Mul, {length, length});
    EXPECT_EQ(area, Value::number(9, Unit::SquareMetre));
    EXPECT_EQ(apply(Fn::Mul, {area, length}), Value::number(27, Unit::CubicMetre));
    EXPECT_EQ(apply(Fn::Div, {area, length}), length);
    EXPECT_EQ(apply(Fn::Div, {apply(Fn::Mul, {length, area}), area}), length);
    EXPECT_EQ(apply(Fn::Div, {area, area}), Value::number(1));
    EXPECT_EQ(apply(Fn::Mul, {area, Value::number(2, Unit::PerMetre)}), Value::number(18, Unit::Metre));
    EXPECT_EQ(apply(Fn::Mul, {Value::number(.5, Unit::Share), area}), Value::number(4.5, Unit::SquareMetre));
    EXPECT_EQ(apply(Fn::Sqrt, {area}), length);
    EXPECT_EQ(apply(Fn::Sqrt, {Value::number(9)}), Value::number(3));
    EXPECT_FALSE(productHasUnit(Unit::SquareMetre, Unit::SquareMetre));
    EXPECT_FALSE(productHasUnit(Unit::Angle, Unit::Angle));
    EXPECT_TRUE(productHasUnit(Unit::CubicMetre, Unit::PerMetre));
}

TEST(Functions, SpreadNumbersOverVectors) {
    EXPECT_EQ(apply(Fn::Mul, {vec(1, 2, 3), Value::number(2)}).n[2], 6);
    EXPECT_EQ(apply(Fn::Max, {vec(4, 9, 3)}), Value::number(9));
    EXPECT_NEAR(apply(Fn::Tan, {Value::number(pi / 4, Unit::Angle)}).num(), 1, 1e-12);
    EXPECT_NEAR(apply(Fn::Atan2, {Value::number(-3, Unit::Metre), Value::number(-3, Unit::Metre)}).num(), -3 * pi / 4,
                1e-12);
    EXPECT_EQ(apply(Fn::Atan2, {Value::number(1), Value::number(2)}).units[0], Unit::Angle);
    EXPECT_EQ(apply(Fn::Pow, {Value::number(2), Value::number(10)}), Value::number(1024));
    EXPECT_EQ(apply(Fn::Pow, {Value::number(-8), Value::number(.5)}), Value::number(0)) << "no number";
    EXPECT_EQ(apply(Fn::Pow, {Value::number(0), Value::number(-1)}), Value::number(0)) << "not infinite";
    EXPECT_EQ(apply(Fn::Min, {vec(4, 9, 3), Value::number(4)}).n[1], 4);
    EXPECT_EQ(component(vec(4, 9, 3), axis(2)).num(), 3);
    EXPECT_EQ(interpolate(vec(0, 0, 0), vec(2, 4, 8), .25).n[2], 2);
}

TEST(Functions, NeverGiveInfinity) {
    EXPECT_EQ(apply(Fn::Div, {Value::number(1), Value::number(0)}).num(), 0);
    EXPECT_EQ(apply(Fn::Rem, {Value::number(1), Value::number(0)}).num(), 0);
    EXPECT_EQ(apply(Fn::Rem, {Value::number(-1), Value::number(3)}).num(), 2) << "floor remainder";
    EXPECT_EQ(apply(Fn::Sqrt, {Value::number(-4)}).num(), 0);
}

TEST(Functions, TurnAxesAndRotations) {
    EXPECT_EQ(apply(Fn::Neg, {axis(4)}).num(), 5);
    EXPECT_EQ(apply(Fn::Neg, {axis(6)}).num(), 6) << "the centre faces nowhere";
    const Value quarter = apply(Fn::RotY, {Value::number(pi / 2, Unit::Angle)});
    const Value half = apply(Fn::Mul, {quarter, quarter});
    EXPECT_NEAR(half.n[0], -1, 1e-12);
    EXPECT_NEAR(half.n[4], 1, 1e-12);
    EXPECT_NEAR(quarter.n[2], -1, 1e-12) << "x turns to -z";
}

TEST(Functions, KeepWholeNumbersWhole) {
    Value two = Value::number(2);
    two.integer = true;
    EXPECT_TRUE(apply(Fn::Add, {two, two}).integer);
    EXPECT_FALSE(apply(Fn::Div, {two, two}).integer);
    EXPECT_TRUE(apply(Fn::Round, {Value::number(2.5)}).integer);
    EXPECT_EQ(apply(Fn::Round, {Value::number(2.5)}).num(), 3);
    EXPECT_EQ(apply(Fn::Equal, {two, Value::number(2)}).truth(), true);
}

}  // namespace
}  // namespace sgm::rules
