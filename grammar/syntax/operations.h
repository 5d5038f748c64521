// The rule-operation table: what a rule body may do to a shape. The definition is the entry: the parser takes names and
// argument counts from it, the checker types and units, the reference page its docs, the fuzzer its vocabulary.
// Enters: nothing. Leaves: rows. Assumes grammar/derive handles every `Operation::Id` (a switch without default).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace sgm::syntax {

/// What an argument of an operation is.
enum class ArgumentType : uint8_t {
    Number,    ///< plain number; also percent
    Length,    ///< metres; bare numbers are metres
    Angle,     ///< degrees
    Size,      ///< a length, a share (30%) or a vector of them; one number scales all three axes
    Vector,    ///< up to three numbers or lengths; one number counts for every axis
    Color,     ///< #rrggbb
    Joint,     ///< a joint name, `centre`, `free(…)`, or a `for … in axes` variable
    Shape,     ///< `last`, `any(d)`
    Noise,     ///< billow(amplitude, frequency), fbm(amplitude, frequency [, octaves])
    Solid,     ///< a terminal or solid expression
    Axis,      ///< x, y or z
    Name,      ///< a bare word (a tag)
};

struct OperationArgument {
    std::string_view name;
    ArgumentType type;
    std::string_view doc;
    bool optional = false;
};

struct Operation {
    /// One enumerator a row, in row order.
    enum class Id : uint8_t {
        Size, Move, Turn, At, To, Overlap, Shift, On, By, Blend, Displace, Color, Rough, Metal, Tag, With,
        Split, Inset, Clad, Thickness, Tile, Mirror, Footprint, Extrude, Faces, Roof, Balcony,
    };
    Id id;
    std::string_view name;
    std::string_view doc;
    std::string_view example;
    std::span<const OperationArgument> arguments;
    bool block = false;      ///< followed by { label: body | … }
    bool supported = true;   ///< false: parsed and checked, then refused with "not supported yet"
};

std::span<const Operation> operations();
/// The row called `name`, or null.
const Operation* findOperation(std::string_view name);

}  // namespace sgm::syntax
