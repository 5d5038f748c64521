// What an expression will evaluate to, known before anything is derived.
// Enters: sample values. Leaves: types, and whether they fit where they stand. Assumes units combine as in evaluate.h:
// a type is a Value whose numbers mean nothing, so the type of f(a, b) is that of f applied to samples of a and b.
#pragma once

#include <string>
#include <vector>

#include "grammar/rules/grammar.h"

namespace sgm::rules {

struct Type {
    Value like;         ///< kind, count, units and integer count; numbers are 1
    bool known = true;  ///< false after an error and for values set by `with`: fits everywhere
    const std::vector<std::string>* words = nullptr;  ///< a Word of a `param … of`: what it may be

    static Type unknown();
    static Type number(Unit unit = Unit::None, bool integer = false);
    static Type of(Value::Kind kind, uint8_t count = 1);
    static Type of(const Value& value);
    bool numeric() const { return like.kind == Value::Kind::Number || like.kind == Value::Kind::Vector; }
};

/// What a place takes.
enum class Want : uint8_t {
    Anything,
    Truth,
    Number,     ///< plain, or a share
    Count,      ///< a whole number
    Length,     ///< metres; bare numbers are metres
    Area,       ///< square metres; bare numbers are square metres
    Frequency,  ///< 1/m, or bare
    Angle,
    Angles,  ///< one, or three
    Size,    ///< lengths or shares, one or three
    Extent,  ///< one length or share
    Offset,  ///< plain numbers, shares or lengths, one or three
    Triple,  ///< plain numbers or lengths, exactly three
    Pair,    ///< plain numbers or lengths, exactly two
    PerId,   ///< plain numbers, one or four
    Color,
    Rotation,
    Axis,
};

/// The place in words: "a length in metres".
std::string_view describe(Want want);
/// The type in words: "an angle", "3 numbers", "a colour".
std::string describe(const Type& type);

/// May a value of `type` stand where `want` is asked for? Unknown types may.
bool fits(const Type& type, Want want);

/// May two numbers meet in a sum, a comparison or a range? A bare number may meet any unit; vectors of different
/// lengths may not meet.
bool compatible(const Type& a, const Type& b);

}  // namespace sgm::rules
