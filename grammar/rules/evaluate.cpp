#include "grammar/rules/evaluate.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "grammar/rules/color.h"

namespace sgm::rules {
namespace {

/// Whether more than arguments decide about the value: the shape, those around it, or the place.
bool dependsOnPlace(Fn fn) {
    constexpr Fn all[] = {Fn::Count,   Fn::Bump,   Fn::Fbm,     Fn::Mean,       Fn::Overlaps,
                          Fn::Touches, Fn::Inside, Fn::Covered, Fn::FileNumber, Fn::FileWord};
    return std::find(std::begin(all), std::end(all), fn) != std::end(all);
}

constexpr size_t maxComponents = 6;

bool isVector(const Value& v) { return v.kind == Value::Kind::Vector; }
size_t at(const Value& v, size_t i) { return v.count > 1 ? std::min<size_t>(i, v.count - 1u) : 0; }
Unit unitAt(const Value& v, size_t i) { return v.units[std::min(at(v, i), v.units.size() - 1)]; }
/// The power of the length in a unit: 2 for m², 0 for a plain number; nothing for angles, shares and `~`.
std::optional<int> lengthPower(Unit unit) {
    switch (unit) {
        case Unit::None:
            return 0;
        case Unit::Metre:
            return 1;
        case Unit::SquareMetre:
            return 2;
        case Unit::CubicMetre:
            return 3;
        case Unit::PerMetre:
            return -1;
        default:
            return std::nullopt;
    }
}
std::optional<Unit> unitOfLengthPower(int power) {
    constexpr Unit units[] = {Unit::PerMetre, Unit::None, Unit::Metre, Unit::SquareMetre, Unit::CubicMetre};
    return power < -1 || power > 3 ? std::nullopt : std::optional(units[power + 1]);
}

/// The unit of a sum, a choice or an interpolation: the one that says more.
Unit either(Unit a, Unit b) { return a == Unit::None ? b : a; }

Unit unitOfQuotient(Unit a, Unit b) {
    if (b == Unit::Share) return a == b ? Unit::None : a;
    const auto dividend = lengthPower(a), divisor = lengthPower(b);
    if (!dividend || !divisor) return a == b ? Unit::None : a;
    return unitOfLengthPower(*dividend - *divisor).value_or(a);
}

/// f on every component, numbers spread over vectors; `unit` from the units of both.
template <class F, class U>
Value componentwise(const Value& a, const Value& b, F f, U unit) {
    Value r;
    r.count = std::max(a.count, b.count);
    r.kind = isVector(a) || isVector(b) ? Value::Kind::Vector : Value::Kind::Number;
    r.integer = a.integer && b.integer;
    for (size_t i = 0; i < std::min<size_t>(r.count, maxComponents); ++i) {
        r.n[i] = f(a.n[at(a, i)], b.n[at(b, i)]);
        r.units[i] = unit(unitAt(a, i), unitAt(b, i));
    }
    return r;
}
template <class F>
Value componentwise(const Value& a, F f) {
    Value r = a;
    for (size_t i = 0; i < r.count; ++i) r.n[i] = f(a.n[i]);
    return r;
}

Value whole(Value v) {
    v.integer = true;
    return v;
}

Mat3 matrixOf(const Value& v) { return {{v.n[0], v.n[1], v.n[2]}, {v.n[3], v.n[4], v.n[5]}, {v.n[6], v.n[7], v.n[8]}}; }
Value rotationOf(const Mat3& m) {
    Value r;
    r.kind = Value::Kind::Rotation;
    r.count = 9;
    r.n = {m.x.x, m.x.y, m.x.z, m.y.x, m.y.y, m.y.z, m.z.x, m.z.y, m.z.z};
    return r;
}

Value multiply(const Value& a, const Value& b) {
    if (a.kind == Value::Kind::Rotation) return rotationOf(matrixOf(a) * matrixOf(b));
    return componentwise(
        a, b, [](double x, double y) { return x * y; }, unitOfProduct);
}
Value divide(const Value& a, const Value& b) {
    Value r = componentwise(
        a, b, [](double x, double y) { return y == 0 ? 0 : x / y; }, unitOfQuotient);
    r.integer = false;
    return r;
}

bool same(const Value& a, const Value& b) {
    if (a.kind == Value::Kind::Word || a.kind == Value::Kind::Text) return a.text == b.text;
    for (size_t i = 0; i < std::max(a.count, b.count); ++i)
        if (a.n[at(a, i)] != b.n[at(b, i)]) return false;
    return true;
}

/// The other face along the same axis; the centre stays.
Value opposite(Value axis) {
    if (axis.num() < maxComponents) axis.n[0] = static_cast<double>(static_cast<int>(axis.num()) ^ 1);
    return axis;
}

Value rgb(std::span<const Value> args) {
    Value r;
    r.kind = Value::Kind::Color;
    r.count = 3;
    for (size_t i = 0; i < 3; ++i) r.n[i] = linearFromSrgb(std::clamp(args[i].num(), 0.0, 1.0));
    return r;
}

/// min and max: of all arguments, or of one vector's components.
template <class F>
Value extreme(std::span<const Value> args, F f) {
    Value r = args[0];
    if (args.size() == 1 && isVector(r)) {
        for (size_t i = 1; i < r.count; ++i) r.n[0] = f(r.n[0], r.n[i]);
        Value one = Value::number(r.n[0], r.units[0]);
        one.integer = r.integer;
        return one;
    }
    for (const Value& v : args.subspan(1)) r = componentwise(r, v, f, either);
    return r;
}
double smaller(double a, double b) { return b < a ? b : a; }
double larger(double a, double b) { return a < b ? b : a; }
double remainder(double a, double b) { return b == 0 ? 0 : a - std::floor(a / b) * b; }

/// What a sign between two values, or before one, makes of them.
Value applyOperator(Fn fn, std::span<const Value> a) {
    const double x = a.empty() ? 0 : a[0].num(), y = a.size() < 2 ? 0 : a[1].num();
    switch (fn) {
        case Fn::Neg:
            if (a[0].kind == Value::Kind::Axis) return opposite(a[0]);
            return componentwise(a[0], [](double v) { return -v; });
        case Fn::Not:
            return Value::boolean(!a[0].truth());
        case Fn::Add:
            return componentwise(
                a[0], a[1], [](double p, double q) { return p + q; }, either);
        case Fn::Sub:
            return componentwise(
                a[0], a[1], [](double p, double q) { return p - q; }, either);
        case Fn::Mul:
            return multiply(a[0], a[1]);
        case Fn::Div:
            return divide(a[0], a[1]);
        case Fn::Rem:
            return componentwise(a[0], a[1], remainder, either);
        case Fn::Less:
            return Value::boolean(x < y);
        case Fn::LessEq:
            return Value::boolean(x <= y);
        case Fn::Greater:
            return Value::boolean(x > y);
        case Fn::GreaterEq:
            return Value::boolean(x >= y);
        case Fn::Equal:
            return Value::boolean(same(a[0], a[1]));
        case Fn::NotEqual:
            return Value::boolean(!same(a[0], a[1]));
        case Fn::And:
            return Value::boolean(a[0].truth() && a[1].truth());
        case Fn::Or:
            return Value::boolean(a[0].truth() || a[1].truth());
        default:
            return {};
    }
}

}  // namespace

Unit unitOfProduct(Unit a, Unit b) {
    if (a == Unit::Share) return b == Unit::None ? a : b;
    const auto first = lengthPower(a), second = lengthPower(b);
    if (!first || !second) return either(a, b);
    return unitOfLengthPower(*first + *second).value_or(a);
}

bool productHasUnit(Unit a, Unit b) {
    const auto first = lengthPower(a), second = lengthPower(b);
    if (first && second) return unitOfLengthPower(*first + *second).has_value();
    return a != Unit::Angle || b != Unit::Angle;
}

namespace {

/// Angles, powers and rotations.
std::optional<Value> applyGeometry(Fn fn, std::span<const Value> a, double x, double y) {
    switch (fn) {
        case Fn::Sqrt:
            return Value::number(std::sqrt(larger(x, 0)),
                                 a[0].units[0] == Unit::SquareMetre ? Unit::Metre : Unit::None);
        case Fn::Sin:
            return Value::number(std::sin(x));
        case Fn::Cos:
            return Value::number(std::cos(x));
        case Fn::Tan:
            return Value::number(std::tan(x));
        case Fn::Atan2:
            return Value::number(std::atan2(x, y), Unit::Angle);
        case Fn::Pow: {
            const double power = std::pow(x, y);
            return Value::number(std::isfinite(power) ? power : 0);
        }
        case Fn::RotX:
            return rotationOf(Mat3::rotation({1, 0, 0}, x));
        case Fn::RotY:
            return rotationOf(Mat3::rotation({0, 1, 0}, x));
        case Fn::RotZ:
            return rotationOf(Mat3::rotation({0, 0, 1}, x));
        default:
            return std::nullopt;
    }
}

}  // namespace

Value applyFunction(Fn fn, std::span<const Value> a) {
    if (fn <= Fn::Or) return applyOperator(fn, a);
    const double x = a.empty() ? 0 : a[0].num(), y = a.size() < 2 ? 0 : a[1].num();
    if (auto value = applyGeometry(fn, a, x, y)) return *std::move(value);
    switch (fn) {
        case Fn::Min:
            return extreme(a, smaller);
        case Fn::Max:
            return extreme(a, larger);
        case Fn::Abs:
            return componentwise(a[0], [](double v) { return std::abs(v); });
        case Fn::Floor:
            return whole(componentwise(a[0], [](double v) { return std::floor(v); }));
        case Fn::Ceil:
            return whole(componentwise(a[0], [](double v) { return std::ceil(v); }));
        case Fn::Round:
            return whole(componentwise(a[0], [](double v) { return std::floor(v + 0.5); }));
        case Fn::Clamp:
            return componentwise(componentwise(a[0], a[1], larger, either), a[2], smaller, either);
        case Fn::Lerp:
            return interpolate(a[0], a[1], a[2].num());
        case Fn::If:
            return a[0].truth() ? a[1] : a[2];
        case Fn::Rgb:
            return rgb(a);
        case Fn::Metres:
            return Value::number(a[0].units[0] == Unit::Share ? x * y : x, Unit::Metre);
        case Fn::Bump:
        case Fn::Fbm:
        case Fn::Mean:
        case Fn::Overlaps:
        case Fn::Touches:
        case Fn::Inside:
        case Fn::Covered:
            return Value::number(0);
        case Fn::FileNumber:
        case Fn::FileWord:
            return a[1];
        case Fn::Count:
            return whole(Value::number(0));
        default:
            return {};
    }
}

const Expr& sizeAlong(const Expr& size, size_t axis) {
    return size.kind == Expr::Kind::Tuple && size.args.size() == 3 ? size.args[axis] : size;
}

Value component(const Value& vector, const Value& index) {
    const double wanted = std::clamp(std::floor(index.num()), 0.0, vector.count - 1.0);
    const size_t i = static_cast<size_t>(wanted);
    Value r = Value::number(vector.n[i], vector.units[std::min(i, vector.units.size() - 1)]);
    r.integer = vector.integer;
    return r;
}

Value tuple(std::span<const Value> parts) {
    Value r;
    r.kind = Value::Kind::Vector;
    r.count = 0;
    r.integer = true;
    for (const Value& part : parts)
        for (size_t i = 0; i < part.count && r.count < maxComponents; ++i, ++r.count) {
            r.n[r.count] = part.n[i];
            r.units[r.count] = part.units[i];
            r.integer = r.integer && part.integer;
        }
    return r;
}

Value interpolate(const Value& a, const Value& b, double t) {
    if (a.kind == Value::Kind::Color) {
        Value r = a;
        for (size_t i = 0; i < 3; ++i) r.n[i] = a.n[i] + (b.n[i] - a.n[i]) * t;
        return r;
    }
    Value r = componentwise(
        a, b, [t](double p, double q) { return p + (q - p) * t; }, either);
    r.integer = false;
    return r;
}

std::optional<Value> fold(const Expr& expr, std::span<const Value> params) {
    if (expr.kind == Expr::Kind::Constant) return expr.value;
    if (expr.kind == Expr::Kind::Param)
        return expr.index < params.size() ? std::optional(params[expr.index]) : std::nullopt;
    std::vector<Value> args;
    for (const Expr& arg : expr.args) {
        auto value = fold(arg, params);
        if (!value) return std::nullopt;
        args.push_back(std::move(*value));
    }
    switch (expr.kind) {
        case Expr::Kind::Element:
            return component(args[0], args[1]);
        case Expr::Kind::Tuple:
            return tuple(args);
        case Expr::Kind::Unary:
        case Expr::Kind::Binary:
        case Expr::Kind::Call:
            if (const Fn fn = static_cast<Fn>(expr.index); dependsOnPlace(fn)) return std::nullopt;
            return applyFunction(static_cast<Fn>(expr.index), args);
        default:
            return std::nullopt;
    }
}

}  // namespace sgm::rules
