// Rows of the op table (ops.h): leaves, arithmetic, minima and maxima, and the morph.
// Enters: values of any type (values.h). Leaves: the ops. Assumes as ops.h does.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "modeler/field/ops_math.h"
#include "modeler/field/relevant_range.h"
#include "modeler/field/values.h"

namespace sgm::field::ops {

struct Input {
    static constexpr std::string_view name = "input";
    static constexpr int arity = leaf;
    static constexpr uint32_t cost = 1;
};
struct Literal {
    static constexpr std::string_view name = "literal";
    static constexpr int arity = leaf;
    static constexpr uint32_t cost = 1;
};
struct Slot {
    static constexpr std::string_view name = "slot";
    static constexpr int arity = leaf;
    static constexpr uint32_t cost = 1;
};
/// The operand itself; only tapes have it.
struct Copy {
    static constexpr std::string_view name = "copy";
    static constexpr int arity = 1;
    static constexpr uint32_t cost = 1;
    template <class V>
    static V apply(V a) {
        return a;
    }
};
struct Add {
    static constexpr std::string_view name = "add";
    static constexpr int arity = 2;
    static constexpr uint32_t cost = 1;
    static constexpr bool commutative = true;
    template <class V>
    static V apply(V a, V b) {
        return a + b;
    }
    static std::optional<RelevantOperands> passOn(RelevantRange relevant, const OperandRange* operands) {
        if (operands[0].isNumber == operands[1].isNumber) return {};
        const uint32_t number = operands[1].isNumber ? 1 : 0;
        const float n = operands[number].lo;
        return besideNumber(number, relevant, n, [n](float end) { return end - n; });
    }
};
struct Sub {
    static constexpr std::string_view name = "sub";
    static constexpr int arity = 2;
    static constexpr uint32_t cost = 1;
    static constexpr float neutralSecond = 0;
    static constexpr bool fallsWithLast = true;
    static constexpr KeptEnd keptEnds[] = {{1, false}, {1, true}};
    template <class V>
    static V apply(V a, V b) {
        return a - b;
    }
    /// a counts between least + b's low end and most + its high end.
    static std::optional<RelevantOperands> passOn(RelevantRange relevant, const OperandRange* operands) {
        const float lo = operands[1].lo, hi = operands[1].hi;
        if (operands[0].isNumber || !(lo <= hi)) return {};
        const auto plus = [](float n) { return [n](float end) { return end + n; }; };
        return RelevantOperands{RelevantRange{moved(relevant, lo, plus(lo)).least, moved(relevant, hi, plus(hi)).most}};
    }
};
struct Mul {
    static constexpr std::string_view name = "mul";
    static constexpr int arity = 2;
    static constexpr uint32_t cost = 1;
    static constexpr float neutralSecond = 1;
    static constexpr bool commutative = true;
    template <class V>
    static V apply(V a, V b) {
        return a * b;
    }
    static std::optional<RelevantOperands> passOn(RelevantRange relevant, const OperandRange* operands) {
        if (operands[0].isNumber == operands[1].isNumber) return {};
        const uint32_t number = operands[1].isNumber ? 1 : 0;
        const float n = operands[number].lo;
        if (!(n > 0)) return {};
        return besideNumber(number, relevant, 0, [n](float end) { return end / n; });
    }
};
struct Div {
    static constexpr std::string_view name = "div";
    static constexpr int arity = 2;
    static constexpr uint32_t cost = 4;
    static constexpr float neutralSecond = 1;
    template <class V>
    static V apply(V a, V b) {
        return a / b;
    }
    static std::optional<RelevantOperands> passOn(RelevantRange relevant, const OperandRange* operands) {
        const float n = operands[1].lo;
        if (operands[0].isNumber || !operands[1].isNumber || !(n > 0)) return {};
        return besideNumber(1, relevant, 0, [n](float end) { return end * n; });
    }
};
struct Neg {
    static constexpr std::string_view name = "neg";
    static constexpr int arity = 1;
    static constexpr uint32_t cost = 1;
    static constexpr bool fallsWithLast = true;
    template <class V>
    static V apply(V a) {
        return -a;
    }
    static std::optional<RelevantOperands> passOn(RelevantRange relevant, const OperandRange*) {
        return RelevantOperands{RelevantRange{-relevant.most, -relevant.least}};
    }
};
struct Abs {
    static constexpr std::string_view name = "abs";
    static constexpr int arity = 1;
    static constexpr uint32_t cost = 1;
    static constexpr Pieces pieces = Pieces::Sides;
    template <class V>
    static V apply(V a) {
        return abs(a);
    }
};
/// √ of what is positive, 0 of the rest.
struct Sqrt {
    static constexpr std::string_view name = "sqrt";
    static constexpr int arity = 1;
    static constexpr uint32_t cost = 6;
    template <class V>
    static V apply(V a) {
        return sqrt(max(V(0.0f), a));
    }
};
struct Square {
    static constexpr std::string_view name = "square";
    static constexpr int arity = 1;
    static constexpr uint32_t cost = 1;
    static constexpr Pieces pieces = Pieces::Forgotten;
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
    static constexpr uint32_t cost = 2;
    template <class V>
    static V apply(V a) {
        return floor(a);
    }
};
/// Floor-modulo a − b·⌊a/b⌋.
struct Mod {
    static constexpr std::string_view name = "mod";
    static constexpr int arity = 2;
    static constexpr uint32_t cost = 8;
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
    static constexpr uint32_t cost = 1;
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
    static constexpr uint32_t cost = 1;
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
    static constexpr uint32_t cost = 16;
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
    static constexpr uint32_t cost = 4;
    static constexpr Pieces pieces = Pieces::OfNearer;
    static constexpr KeptEnd keptEnds[] = {{0, false}, {1, false}};
    static constexpr size_t operandCount = 3, varyingOperands = 3;
    static constexpr Owner owner = Owner::Nearer;
    enum Operand : size_t { from, to, share };
    static constexpr GlslNumber glslNumbers[] = {{"atFrom", from}, {"atTo", to}, {"atShare", share}};
    static constexpr std::string_view glsl =
        "float t = arg(first + atShare); return arg(first + atFrom) * (1.0 - t) + arg(first + atTo) * t;";
    template <class V>
    static V apply(std::span<const V> args, uint32_t) {
        return args[from] * (1.0f - args[share]) + args[to] * args[share];
    }
    /// Between 0 and 1 neither counts above what the other at its lowest leaves it. Both may be above at once, for the
    /// two at their lowest stay below `most`; from below the same would hold for but one of them.
    static std::optional<RelevantOperands> passOn(RelevantRange relevant, const OperandRange* operands) {
        if (!operands[share].isNumber) return {};
        const float t = operands[share].lo, s = 1 - t, a = operands[from].lo, b = operands[to].lo;
        const float most = relevant.most;
        if (!(t > 0 && t < 1) || !(a * s + b * t <= most)) return {};
        const auto left = [most](float own, float others, float other) {
            const float end = (most - others * other) / own;
            return end + 1e-5f * (std::abs(end) + (std::abs(most) + std::abs(other)) / own);
        };
        return RelevantOperands{RelevantRange{RelevantRange{}.least, left(s, t, b)},
                                RelevantRange{RelevantRange{}.least, left(t, s, a)}};
    }
};

}  // namespace sgm::field::ops
