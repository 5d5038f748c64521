// Values with their units, as parameters, attributes and expressions carry them.
// Enters: numbers. Leaves: small plain values. Assumes metres and radians inside; units say how a number was meant.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "modeler/core/vec.h"

namespace sgm::rules {

/// How a number was meant. Angles are held in radians, percentages as shares of 1.
enum class Unit : uint8_t { None, Metre, Angle, Share, PerMetre, Floating, SquareMetre, CubicMetre };

struct Value {
    enum class Kind : uint8_t { Number, Bool, Vector, Color, Word, Text, Rotation, Axis };
    Kind kind = Kind::Number;
    uint8_t count = 1;            ///< numbers in use: a vector's components (up to 9)
    bool integer = false;         ///< the number was written without point or unit
    std::array<Unit, 6> units{};  ///< per component
    std::array<double, 9> n{};    ///< Number, Bool: n[0]; Color: linear rgb; Rotation: matrix by columns;
                                  ///< Axis: n[0] = 0 … 5 for +x −x +y −y +z −z, 6 = centre
    std::string text;             ///< Word, Text

    static Value number(double v, Unit unit = Unit::None) {
        Value r;
        r.n[0] = v;
        r.units[0] = unit;
        return r;
    }
    static Value boolean(bool b) {
        Value r;
        r.kind = Kind::Bool;
        r.n[0] = b;
        return r;
    }
    double num() const { return n[0]; }
    bool truth() const { return n[0] != 0; }
    friend bool operator==(const Value&, const Value&) = default;
};

/// As it would be written in a grammar: "1.2m", "12deg", "(1, 2, 3)", "#c8b090", "flat".
std::string toText(const Value& value);

}  // namespace sgm::rules
