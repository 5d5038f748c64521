#include "grammar/rules/value.h"

#include <fmt/format.h>

#include <cmath>

#include "grammar/rules/color.h"
#include "modeler/core/conventions.h"

namespace sgm::rules {
namespace {

constexpr std::array<const char*, 7> axisNames{"+x", "-x", "+y", "-y", "+z", "-z", "centre"};

/// Twelve digits: enough for any sensible number, and radians come back as the degrees that were written.
std::string digits(double v, const char* unit) { return fmt::format("{:.12g}{}", v == 0 ? 0.0 : v, unit); }

std::string numberText(double v, Unit unit) {
    switch (unit) {
        case Unit::None:
            return digits(v, "");
        case Unit::Metre:
            return digits(v, "m");
        case Unit::Angle:
            return digits(degrees(v), "deg");
        case Unit::Share:
            return digits(v * 100, "%");
        case Unit::PerMetre:
            return digits(v, "/m");
        case Unit::Floating:
            return fmt::format("~{:.12g}", v);
        case Unit::SquareMetre:
            return digits(v, "m2");
        case Unit::CubicMetre:
            return digits(v, "m3");
    }
    return {};
}

std::string tupleText(const Value& value, size_t count) {
    std::string text = "(";
    for (size_t i = 0; i < count; ++i) {
        const Unit unit = i < value.units.size() ? value.units[i] : Unit::None;
        if (i) text += ", ";
        text += numberText(value.n[i], unit);
    }
    return text + ")";
}

}  // namespace

std::string toText(const Value& value) {
    switch (value.kind) {
        case Value::Kind::Number:
            return numberText(value.n[0], value.units[0]);
        case Value::Kind::Bool:
            return value.truth() ? "true" : "false";
        case Value::Kind::Vector:
            return tupleText(value, value.count);
        case Value::Kind::Color:
            return fmt::format("#{:06x}", hexFromLinear({value.n[0], value.n[1], value.n[2]}));
        case Value::Kind::Word:
            return value.text;
        case Value::Kind::Text:
            return fmt::format("\"{}\"", value.text);
        case Value::Kind::Rotation:
            return fmt::format("rotation{}", tupleText(value, 9));
        case Value::Kind::Axis:
            return axisNames[static_cast<size_t>(value.n[0])];
    }
    return {};
}

}  // namespace sgm::rules
