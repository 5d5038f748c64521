// The op table: every elementary function a field can be made of, said once.
// Enters: values of any type (modeler/field/values.h). Leaves: OpCode, its name and traits, and dispatch over the
// rows. Assumes nothing but + − × ÷ √ min max and integers in the bodies: that keeps bits equal on all machines.
//
// To add an op: write a row (a struct, below or in a header of its own) and name it in `OpTable`. Nothing else changes:
// tapes, kernels, intervals, derivatives, GLSL and the conformance tests are made from the row.
//   name, arity                          operands: 1, 2, or `variadic`
//   V apply(a) | apply(a, b) | apply(span<const V> args, uint32_t data)      the op itself, over any V
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
//   selects = true                       the result is one of the operands, so that values which the consumer of the
//                                        result doesn't tell apart needn't be told apart in the operands either
//   hasSides = true                      the surface has an edge where its two operands are equal, as at their maximum
//   glsl                                 body of `float op_NAME(uint first, uint count, uint data)`, in which operand
//                                        i is `arg(first + i)`; needed by variadic rows: a loop can't become one
//                                        expression. word(data, i) is the i-th word of the grid
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>

#include "modeler/field/blend_op.h"
#include "modeler/field/facade_op.h"
#include "modeler/field/graph.h"
#include "modeler/field/heights_op.h"
#include "modeler/field/kifs.h"
#include "modeler/field/noise.h"
#include "modeler/field/ops_math.h"
#include "modeler/field/sampled_op.h"
#include "modeler/field/solid_ops.h"
#include "modeler/field/transcendental_ops.h"
#include "modeler/field/values.h"

namespace sgm::field::ops {

struct Input {
    static constexpr std::string_view name = "input";
    static constexpr int arity = leaf;
};
struct Literal {
    static constexpr std::string_view name = "literal";
    static constexpr int arity = leaf;
};
struct Slot {
    static constexpr std::string_view name = "slot";
    static constexpr int arity = leaf;
};
/// The operand itself; only tapes have it.
struct Copy {
    static constexpr std::string_view name = "copy";
    static constexpr int arity = 1;
    template <class V>
    static V apply(V a) {
        return a;
    }
};
struct Add {
    static constexpr std::string_view name = "add";
    static constexpr int arity = 2;
    static constexpr bool commutative = true;
    template <class V>
    static V apply(V a, V b) {
        return a + b;
    }
};
struct Sub {
    static constexpr std::string_view name = "sub";
    static constexpr int arity = 2;
    template <class V>
    static V apply(V a, V b) {
        return a - b;
    }
};
struct Mul {
    static constexpr std::string_view name = "mul";
    static constexpr int arity = 2;
    static constexpr bool commutative = true;
    template <class V>
    static V apply(V a, V b) {
        return a * b;
    }
};
struct Div {
    static constexpr std::string_view name = "div";
    static constexpr int arity = 2;
    template <class V>
    static V apply(V a, V b) {
        return a / b;
    }
};
struct Neg {
    static constexpr std::string_view name = "neg";
    static constexpr int arity = 1;
    template <class V>
    static V apply(V a) {
        return -a;
    }
};
struct Abs {
    static constexpr std::string_view name = "abs";
    static constexpr int arity = 1;
    template <class V>
    static V apply(V a) {
        return abs(a);
    }
};
/// √ of what is positive, 0 of the rest.
struct Sqrt {
    static constexpr std::string_view name = "sqrt";
    static constexpr int arity = 1;
    template <class V>
    static V apply(V a) {
        return sqrt(max(V(0.0f), a));
    }
};
struct Square {
    static constexpr std::string_view name = "square";
    static constexpr int arity = 1;
    template <class V>
    static V apply(V a) {
        return a * a;
    }
    template <class I>
    static I interval(I a) {
        const I m = abs(a);
        return I{m.lo * m.lo, m.hi * m.hi};
    }
};
struct Floor {
    static constexpr std::string_view name = "floor";
    static constexpr int arity = 1;
    template <class V>
    static V apply(V a) {
        return floor(a);
    }
};
/// Floor-modulo a − b·⌊a/b⌋.
struct Mod {
    static constexpr std::string_view name = "mod";
    static constexpr int arity = 2;
    template <class V>
    static V apply(V a, V b) {
        return a - b * floor(a / b);
    }
    /// Within one period the plain extension is tight; across several the result is in [0, b] but for rounding.
    template <class I>
    static I interval(I a, I b) {
        using V = typename I::Value;
        const I plain = a - b * floor(a / b);
        const V slack = max(max(abs(a.lo), abs(a.hi)), b.hi) * 5e-7f;
        const auto known = b.lo > V(0.0f);
        return I{select(known, max(-slack, plain.lo), plain.lo), select(known, min(b.hi + slack, plain.hi), plain.hi)};
    }
};

struct Min {
    static constexpr std::string_view name = "min";
    static constexpr int arity = 2;
    static constexpr bool commutative = true;
    static constexpr Owner owner = Owner::Least;
    template <class V>
    static V apply(V a, V b) {
        return min(a, b);
    }
    static constexpr bool selects = true;
    template <class I>
    static auto pruneBound(std::span<const I> args, uint32_t) {
        return min(args[0].hi, args[1].hi);
    }
};
struct Max {
    static constexpr std::string_view name = "max";
    static constexpr int arity = 2;
    static constexpr bool commutative = true;
    static constexpr Owner owner = Owner::Greatest;
    template <class V>
    static V apply(V a, V b) {
        return max(a, b);
    }
    static constexpr bool selects = true;
    template <class I>
    static auto pruneBound(std::span<const I> args, uint32_t) {
        return max(args[0].lo, args[1].lo);
    }
};
/// Distance to the rim where two perpendicular faces meet, from the distances to both: |max((a, b), 0)| +
/// min(max(a, b), 0).
struct Rim {
    static constexpr std::string_view name = "rim";
    static constexpr int arity = 2;
    static constexpr bool hasSides = true;
    template <class V>
    static V apply(V a, V b) {
        const V zero = 0.0f;
        // On the surface the second operand wins: the derivative is the face's.
        return Sqrt::apply(Square::apply(max(zero, a)) + Square::apply(max(zero, b))) + min(zero, max(a, b));
    }
    /// It grows with both.
    template <class I>
    static I interval(I a, I b) {
        return I{apply(a.lo, b.lo), apply(a.hi, b.hi)};
    }
};
/// a·(1 − t) + b·t over (a, b, t): SG-M eq. 14.
struct Morph {
    static constexpr std::string_view name = "morph";
    static constexpr int arity = variadic;
    static constexpr size_t operandCount = 3, varyingOperands = 3;
    static constexpr Owner owner = Owner::Nearer;
    static constexpr std::string_view glsl =
        "float t = arg(first + 2u); return arg(first) * (1.0 - t) + arg(first + 1u) * t;";
    template <class V>
    static V apply(std::span<const V> args, uint32_t) {
        return args[0] * (1.0f - args[2]) + args[1] * args[2];
    }
};

}  // namespace sgm::field::ops

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

/// What a row says about itself without its body.
struct OpTraits {
    std::string_view name;
    int arity;
    bool commutative;
    bool chooses;  ///< has a reach
    bool selects;
    bool readsGrid;
    bool hasSides;
    uint32_t firstPrunable;  ///< operands before it are never dropped
    ops::Owner owner;
    std::string_view glsl;  ///< empty where the body is made from apply
};

template <class Row>
constexpr OpTraits traitsOf() {
    OpTraits t{Row::name, Row::arity, false, false, false, false, false, 0, ops::Owner::First, {}};
    if constexpr (requires { Row::commutative; }) t.commutative = Row::commutative;
    if constexpr (requires { Row::selects; }) t.selects = Row::selects;
    if constexpr (requires { Row::readsGrid; }) t.readsGrid = Row::readsGrid;
    if constexpr (requires { Row::hasSides; }) t.hasSides = Row::hasSides;
    if constexpr (requires { Row::firstPrunable; }) t.firstPrunable = Row::firstPrunable;
    if constexpr (requires { Row::owner; }) t.owner = Row::owner;
    if constexpr (requires { Row::glsl; }) t.glsl = Row::glsl;
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
    return (number == 1.0f && (op == codeOf<ops::Mul> || op == codeOf<ops::Div>)) ||
           (std::bit_cast<uint32_t>(number) == 0 && op == codeOf<ops::Sub>);
}

}  // namespace sgm::field
