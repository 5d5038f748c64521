// Checked expressions: what stands where a value does.
// Enters: nothing. Leaves: the tree that grammar/derive evaluates. Assumes indices of the Grammar that holds it.
#pragma once

#include <vector>

#include "grammar/rules/value.h"
#include "grammar/syntax/source.h"

namespace sgm::rules {

using syntax::SourceSpan;

/// Index of a symbol (terminal or non-terminal) in Grammar::symbols.
using SymbolId = uint32_t;
inline constexpr uint32_t none = 0xffffffffu;

/// A checked expression, evaluated by grammar/derive against a shape, parameters and locals.
struct Expr {
    enum class Kind : uint8_t {
        Constant,   ///< value
        Param,      ///< index into Grammar::params
        Local,      ///< index into the frame of locals: `for` variables, `i` of a repeat
        Inherited,  ///< value.text: a value set by `with`, looked up the tree
        Scope,      ///< index 0 … 2: scope.x, .y, .z in metres; 3: scope.area, of its plan, in square metres;
                    ///< extentIndex … + 2: what shares along x, y, z are of, in metres
        Here,       ///< index 0 … 2: where the shape stands, metres in the object's frame
        Map,        ///< index into Grammar::maps: its value there
        Element,    ///< args[0][args[1]] of a vector (an axis indexes 0 … 5)
        Tuple,      ///< args
        Unary,
        Binary,  ///< index is a Fn
        Call,    ///< index is a Fn over args
        Range,   ///< args[0] … args[1]: drawn from the shape's stream under `draw`
        Ramp,    ///< args[0] ~> args[1]: linear over the chain
        Choose,  ///< args[1], args[3], … drawn under `draw` by the weights args[0], args[2], …; index is a Series
                 ///< and value the local that counts its draws
        Figure,  ///< index is a Figure: in `check … expect`
    };
    static constexpr uint32_t extentIndex = 4;
    Kind kind = Kind::Constant;
    bool asksUnits = false;  ///< over numbers of one unit, and a unit is known only while deriving: `with` sets a value
    SourceSpan span;
    Value value;
    uint32_t index = 0;
    uint64_t draw =
        0;  ///< Range, Choose: hash of the attribute's name (and ordinal where one attribute has several ranges)
    std::vector<Expr> args;
};

/// How a `choose` draws along a repetition.
enum class Series : uint8_t {
    None,      ///< every draw by itself
    Distinct,  ///< unlike the one before
    Shuffled,  ///< each once before any comes again, and none twice in a row
};

/// Built-in functions and operators of expressions.
enum class Fn : uint32_t {
    Neg,
    Not,
    Add,
    Sub,
    Mul,
    Div,
    Rem,
    Less,
    LessEq,
    Greater,
    GreaterEq,
    Equal,
    NotEqual,
    And,
    Or,
    Min,
    Max,
    Abs,
    Floor,
    Ceil,
    Round,
    Sqrt,
    Sin,
    Cos,
    Tan,
    Atan2,  ///< an angle
    Pow,
    Clamp,
    Lerp,
    If,
    RotX,
    RotY,
    RotZ,  ///< a Rotation from an angle
    Rgb,
    Bump,      ///< of the place: bump((x, z), radius)
    Fbm,       ///< of the place: fbm(size, octaves [, seed])
    Mean,      ///< of args[0], asked over the plan of the shape's scope
    Overlaps,  ///< whether another shape of a name shares volume with this one; args[0] as of Count
    Touches,   ///< whether one meets it or shares volume with it
    Inside,    ///< whether one holds it whole
    Covered,   ///< the share of its outer face (+z) at or in other solids
    Count,  ///< number of live or derived shapes of a symbol: count(Name); args[0] is a Word whose n[0] is the SymbolId
    FileNumber,  ///< what the file says of the outline a shape stands on; args[0] is the property, args[1] what else
    FileWord,    ///< the same as a word
    Metres,      ///< of a measure and the scope's extent: shares become metres, bare numbers are metres
};
/// What `check … expect` may ask of a derivation.
// clang-format off
enum class Figure : uint32_t { Bonds, Overlaps, Shapes, Terminals, Classic, Morphic, Floating, Roads, Blocks, Lots,
                               Places, Objects, Report };  ///< Places: where `place` puts objects; Objects: different
                                                           ///< ones; Report: the sum of value.n[0] in Grammar::reports
// clang-format on

}  // namespace sgm::rules
