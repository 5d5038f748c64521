#include "grammar/rules/type.h"

#include <fmt/format.h>

#include <algorithm>

namespace sgm::rules {
namespace {

Unit unitAt(const Value& v, size_t i) { return v.units[std::min<size_t>(v.count > 1 ? i : 0, v.units.size() - 1)]; }

template <class Allowed>
bool everyUnit(const Value& v, Allowed allowed) {
    for (size_t i = 0; i < v.count; ++i)
        if (!allowed(unitAt(v, i))) return false;
    return true;
}

bool plain(Unit u) { return u == Unit::None || u == Unit::Share; }
bool length(Unit u) { return u == Unit::None || u == Unit::Metre; }
bool measure(Unit u) { return plain(u) || u == Unit::Metre; }

std::string_view describe(Unit unit) {
    switch (unit) {
        case Unit::None:
            return "a plain number";
        case Unit::Metre:
            return "a length";
        case Unit::Angle:
            return "an angle";
        case Unit::Share:
            return "a share (%)";
        case Unit::PerMetre:
            return "a frequency (1/m)";
        case Unit::Floating:
            return "a floating size (~)";
        case Unit::SquareMetre:
            return "an area";
        case Unit::CubicMetre:
            return "a volume";
    }
    return {};
}

}  // namespace

Type Type::unknown() {
    Type t;
    t.known = false;
    t.like.n.fill(1);
    return t;
}
Type Type::number(Unit unit, bool integer) {
    Type t;
    t.like = Value::number(1, unit);
    t.like.integer = integer;
    return t;
}
Type Type::of(Value::Kind kind, uint8_t count) {
    Type t;
    t.like.kind = kind;
    t.like.count = count;
    t.like.n.fill(1);
    return t;
}
Type Type::of(const Value& value) {
    Type t;
    t.like = value;
    t.like.n.fill(1);
    return t;
}

std::string_view describe(Want want) {
    switch (want) {
        case Want::Anything:
            return "a value";
        case Want::Truth:
            return "something true or false";
        case Want::Number:
            return "a plain number";
        case Want::Count:
            return "a whole number";
        case Want::Length:
            return "a length in metres";
        case Want::Area:
            return "an area in square metres (420m2)";
        case Want::Frequency:
            return "a frequency (2.2/m)";
        case Want::Angle:
            return "an angle (30deg)";
        case Want::Angles:
            return "an angle (30deg), or three";
        case Want::Size:
            return "a length, a share (30%) or (x, y, z) of them";
        case Want::Extent:
            return "a length or a share (30%)";
        case Want::Offset:
            return "a number, a length or (x, y, z) of them";
        case Want::Triple:
            return "three numbers (x, y, z)";
        case Want::Pair:
            return "a point (.2m, .5m)";
        case Want::PerId:
            return "one plain number, or four: one for each facade id";
        case Want::Color:
            return "a colour (#rrggbb)";
        case Want::Rotation:
            return "a rotation: rotX(a), rotY(a) or rotZ(a)";
        case Want::Axis:
            return "a direction such as +x";
    }
    return {};
}

std::string describe(const Type& type) {
    switch (type.like.kind) {
        case Value::Kind::Number:
            return std::string(describe(type.like.units[0]));
        case Value::Kind::Vector:
            return fmt::format("a vector of {}", type.like.count);
        case Value::Kind::Bool:
            return "true or false";
        case Value::Kind::Color:
            return "a colour";
        case Value::Kind::Word:
            return "a word";
        case Value::Kind::Text:
            return "a text";
        case Value::Kind::Rotation:
            return "a rotation";
        case Value::Kind::Axis:
            return "a direction";
    }
    return {};
}

bool fits(const Type& type, Want want) {
    if (!type.known || want == Want::Anything) return true;
    const Value& v = type.like;
    const bool one = v.kind == Value::Kind::Number;
    const bool three = v.kind == Value::Kind::Vector && v.count == 3;
    switch (want) {
        case Want::Anything:
            return true;
        case Want::Truth:
            return v.kind == Value::Kind::Bool;
        case Want::Number:
            return one && everyUnit(v, plain);
        case Want::Count:
            return one && v.integer && v.units[0] == Unit::None;
        case Want::Length:
            return one && everyUnit(v, length);
        case Want::Area:
            return one && (v.units[0] == Unit::None || v.units[0] == Unit::SquareMetre);
        case Want::Frequency:
            return one && (v.units[0] == Unit::None || v.units[0] == Unit::PerMetre);
        case Want::Angle:
            return one && v.units[0] == Unit::Angle;
        case Want::Angles:
            return (one || three) && everyUnit(v, [](Unit u) { return u == Unit::Angle; });
        case Want::Extent:
            return one && everyUnit(v, measure);
        case Want::Size:
        case Want::Offset:
            return (one || three) && everyUnit(v, measure);
        case Want::Triple:
            return three && everyUnit(v, measure);
        case Want::Pair:
            return v.kind == Value::Kind::Vector && v.count == 2 && everyUnit(v, length);
        case Want::PerId:
            return (one || (v.kind == Value::Kind::Vector && v.count == 4)) && everyUnit(v, plain);
        case Want::Color:
            return v.kind == Value::Kind::Color;
        case Want::Rotation:
            return v.kind == Value::Kind::Rotation;
        case Want::Axis:
            return v.kind == Value::Kind::Axis;
    }
    return false;
}

bool compatible(const Type& a, const Type& b) {
    if (!a.known || !b.known) return true;
    if (a.like.count != b.like.count && a.like.count != 1 && b.like.count != 1) return false;
    for (size_t i = 0; i < std::max(a.like.count, b.like.count); ++i) {
        const Unit ua = unitAt(a.like, i), ub = unitAt(b.like, i);
        if (ua != ub && ua != Unit::None && ub != Unit::None) return false;
    }
    return true;
}

}  // namespace sgm::rules
