// The op table: every elementary function a field can be made of, said once.
// Enters: values of any type (modeler/field/values.h). Leaves: OpCode, its name and traits, and dispatch over the
// rows. Assumes nothing but + − × ÷ √ min max and integers in the bodies: that keeps bits equal on all machines.
//
// To add an op: write a row (a struct, in elementary_ops.h or a header of its own) and name it in `OpTable`. Nothing
// else changes: tapes, kernels, intervals, derivatives, GLSL and the conformance tests are made from the row.
//   name, arity                          operands: 1, 2, or `variadic`
//   V apply(a) | apply(a, b) | apply(span<const V> args, uint32_t data)      the op itself, over any V
//   cost | cost(operands, data)          what it takes at a point, in additions, about; at least 1
// and, where the default won't do or could be better:
//   operandCount, varyingOperands        of a variadic row: it always has so many operands, and those from
//                                        `varyingOperands` on are mostly numbers: kernels are fast then
//   commutative = true                   operands may be ordered
//   I interval(…same operands as I…)     an enclosure of apply's floats, rounding included; operands' bounds are
//                                        never NaN. The default is apply over intervals: rounding is monotone, so it
//                                        encloses
//   D gradient(…same operands as D…)     value (same bits as apply) and derivatives; the default is apply over Dual
//   Slopes<V> slopes<V>(at)              for a row of a position and numbers, at(i) its operands: the value and its
//                                        derivatives by the position, all that is needed where that is x, y, z
//   UniformParams<V>(args, data)         for a row most of whose operands are numbers: what it makes of those, once
//                                        for all points. V evalUniform<path>(const V* varying, numbers) gives apply's
//                                        bits from numbers that are V, or floats: then with derivatives where V has
//                                        them; paths are told apart by visitPath(numbers.form, …)
//   owner                                which operand owns the surface (Owner)
//   V pruneBound(span<const I>, data)    for Owner::Least (Greatest): an operand that lies above (below) it can't
//                                        matter: the bits stay the same without it or with any other number beyond
//                                        it. With one operand left the op is that operand, bit for bit. Operands
//                                        before `firstPrunable` are never dropped
//   readsGrid = true                     `data` is the number of a SampledGrid in the graph, and every function above
//                                        that takes `uint32_t data` takes the grid's words, `const float* grid`
//   passOn(relevant, operands)           what of its first three operands matters, from what of its result does
//                                        (relevant_range.h); nothing where all of it. `keptEnds`: two ends of operands'
//                                        bounds that it asks for
//   shownBy(relevant, first)             for rows that choose: what of the result matters, as far as operands show it
//   foldSteps(data)                      how many steps the op folds space in; `foldsEverywhere` where every point does
//   pieces                               how it names pieces of surface from those of its operands (Pieces)
//   neutralSecond                        op(a, number) is a, bit for bit, whatever a is
//   fallsWithLast = true                 it falls where its last operand rises
//   selects = true                       the result is one of the operands, so that values which the consumer of the
//                                        result doesn't tell apart needn't be told apart in the operands either
//   hasSides = true                      the surface has an edge where its two operands are equal, as at their maximum
//   glsl                                 body of `float op_NAME(uint first, uint count, uint data)`, in which operand
//                                        i is `arg(first + i)`, three from i on `arg3(first + i)`; needed by variadic
//                                        rows: a loop can't become one expression. word(data, i) is the i-th word of
//                                        the grid. No place or bit is written there as a number: `glslNumbers` gives
//                                        the names of the enum's to the shader
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "modeler/field/blend_op.h"
#include "modeler/field/elementary_ops.h"
#include "modeler/field/facade_op.h"
#include "modeler/field/graph.h"
#include "modeler/field/heights_op.h"
#include "modeler/field/kifs.h"
#include "modeler/field/noise.h"
#include "modeler/field/relevant_range.h"
#include "modeler/field/sampled_op.h"
#include "modeler/field/solid_ops.h"
#include "modeler/field/transcendental_ops.h"
#include "modeler/field/values.h"

namespace sgm::field {

/// A type list; an op's code is its place here.
template <class... Rows>
struct TypeList {
    static constexpr size_t size = sizeof...(Rows);
};
using OpTable = TypeList<ops::Input, ops::Literal, ops::Slot, ops::Copy, ops::Add, ops::Sub, ops::Mul, ops::Div,
                         ops::Neg, ops::Abs, ops::Sqrt, ops::Square, ops::Floor, ops::Mod, ops::Min, ops::Max, ops::Rim,
                         ops::Morph, ops::Sin, ops::Cos, ops::Exp, ops::Atan2, ops::Kifs, ops::Noise, ops::Blend,
                         ops::Ball, ops::Box, ops::Sampled, ops::Facade, ops::Heights>;

namespace detail {
template <class Row, class... Rows>
constexpr OpCode place(TypeList<Rows...>) {
    uint16_t i = 0, at = 0;
    ((std::is_same_v<Row, Rows> ? at = i : 0, ++i), ...);
    return OpCode{at};
}
template <class Row, class... Rows>
constexpr bool holds(TypeList<Rows...>) {
    return (std::is_same_v<Row, Rows> || ...);
}
template <class Fn, class... Rows>
constexpr decltype(auto) visit(OpCode code, Fn&& fn, TypeList<Rows...>) {
    using R = decltype(fn.template operator()<ops::Input>());
    using Call = R (*)(Fn&);
    constexpr Call calls[] = {[](Fn& f) -> R { return f.template operator()<Rows>(); }...};
    return calls[static_cast<size_t>(code)](fn);
}
}  // namespace detail

/// The code of a row.
template <class Row>
requires(detail::holds<Row>(OpTable{})) inline constexpr OpCode codeOf = detail::place<Row>(OpTable{});

/// fn.operator()<Row>() for the row of `code`. All rows must give the same type.
template <class Fn>
constexpr decltype(auto) visitOp(OpCode code, Fn&& fn) {
    return detail::visit(code, fn, OpTable{});
}

/// What a row says to those who shorten tapes. Functions that a row doesn't have are null.
struct PruningTraits {
    uint32_t firstPrunable = 0;         ///< operands before it are never dropped
    const KeptEnd* keptEnds = nullptr;  ///< two
    std::optional<RelevantOperands> (*passOn)(RelevantRange relevant, const OperandRange* operands) = nullptr;
    RelevantRange (*shownBy)(RelevantRange relevant, OperandRange first) = nullptr;
};
/// What a row says to those who write shaders.
struct ShaderTraits {
    std::string_view glsl = {};  ///< empty where the body is made from apply
    std::span<const ops::GlslNumber> glslNumbers = {};
};
/// What a row says about itself without its body.
struct OpTraits : PruningTraits, ShaderTraits {
    std::string_view name;
    int arity = 0;
    bool commutative = false;
    bool chooses = false;  ///< has a reach
    bool selects = false;
    bool readsGrid = false;
    bool hasSides = false;
    bool fallsWithLast = false;
    bool foldsEverywhere = false;
    ops::Owner owner = ops::Owner::First;
    ops::Pieces pieces = ops::Pieces::OfOperands;
    std::optional<float> neutralSecond = std::nullopt;
    /// Additions that an instruction of so many operands and this structural integer takes at a point, about.
    uint32_t (*cost)(uint32_t operands, uint32_t data) = nullptr;
    uint32_t (*foldSteps)(uint32_t data) = nullptr;
};

template <class Row>
constexpr OpTraits traitsOf() {
    OpTraits t;
    t.name = Row::name, t.arity = Row::arity;
    if constexpr (requires { Row::commutative; }) t.commutative = Row::commutative;
    if constexpr (requires { Row::selects; }) t.selects = Row::selects;
    if constexpr (requires { Row::readsGrid; }) t.readsGrid = Row::readsGrid;
    if constexpr (requires { Row::hasSides; }) t.hasSides = Row::hasSides;
    if constexpr (requires { Row::fallsWithLast; }) t.fallsWithLast = Row::fallsWithLast;
    if constexpr (requires { Row::foldsEverywhere; }) t.foldsEverywhere = Row::foldsEverywhere;
    if constexpr (requires { Row::firstPrunable; }) t.firstPrunable = Row::firstPrunable;
    if constexpr (requires { Row::owner; }) t.owner = Row::owner;
    if constexpr (requires { Row::pieces; }) t.pieces = Row::pieces;
    if constexpr (requires { Row::neutralSecond; }) t.neutralSecond = Row::neutralSecond;
    if constexpr (requires { Row::cost(1u, 0u); })
        t.cost = Row::cost;
    else
        t.cost = [](uint32_t, uint32_t) { return Row::cost; };
    if constexpr (requires { Row::foldSteps(0u); }) t.foldSteps = Row::foldSteps;
    if constexpr (requires { Row::keptEnds; }) t.keptEnds = Row::keptEnds;
    if constexpr (requires { &Row::passOn; }) t.passOn = Row::passOn;
    if constexpr (requires { &Row::shownBy; }) t.shownBy = Row::shownBy;
    if constexpr (requires { Row::glsl; }) t.glsl = Row::glsl;
    if constexpr (requires { Row::glslNumbers; }) t.glslNumbers = Row::glslNumbers;
    t.chooses = t.owner == ops::Owner::Least || t.owner == ops::Owner::Greatest;
    return t;
}

namespace detail {
template <class... Rows>
constexpr std::array<OpTraits, sizeof...(Rows)> allTraits(TypeList<Rows...>) {
    return {traitsOf<Rows>()...};
}
inline constexpr auto opTraits = allTraits(OpTable{});
}  // namespace detail

/// The traits of a code.
constexpr const OpTraits& traits(OpCode code) { return detail::opTraits[static_cast<size_t>(code)]; }
inline constexpr size_t opCount = OpTable::size;

/// True where op(a, number) is a, bit for bit, whatever a is.
constexpr bool keepsFirst(OpCode op, float number) {
    const std::optional<float>& neutral = traits(op).neutralSecond;
    return neutral && std::bit_cast<uint32_t>(number) == std::bit_cast<uint32_t>(*neutral);
}

}  // namespace sgm::field
