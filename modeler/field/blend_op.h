// The order-free n-ary smooth union as an op: Σ max(0, c − fᵢ)² = k², f = c − k.
// Enters: operand 0 is the radius k ≥ 0, the others are the fields. Leaves: their smooth union; exactly their minimum,
// in every bit, where no two are within k of each other. Assumes nothing about the order or number of the fields.
// Solved relative to the least field m: with dᵢ = fᵢ − m and c' = c − m, Newton's iteration from c' = k falls
// monotonically on the convex Σ max(0, c' − dᵢ)² − k². A field with dᵢ ≥ k adds only zeros, so dropping it can't change
// a bit.
#pragma once

#include <span>
#include <string_view>

#include "modeler/field/relevant_range.h"
#include "modeler/field/values.h"

namespace sgm::field::ops {

struct Blend {
    static constexpr std::string_view name = "blend";
    static constexpr int arity = variadic;
    static constexpr Owner owner = Owner::Least;
    static constexpr uint32_t firstPrunable = 1;
    static constexpr Pieces pieces = Pieces::Joined;
    /// Two steps of Newton at most points.
    static constexpr uint32_t cost(uint32_t operands, uint32_t) { return 10 * operands; }
    /// Far more than Newton needs: about ½ log₂ n + 5.
    static constexpr int maxSteps = 40;

    enum Operand : size_t { radius, fields };
    static constexpr GlslNumber glslNumbers[] = {
        {"atRadius", radius}, {"atFields", fields}, {"mostSteps", size_t{maxSteps}}};
    static constexpr std::string_view glsl =
        "float k = arg(first + atRadius), m = arg(first + atFields);\n"
        "for (uint i = atFields + 1u; i < count; ++i) m = min(arg(first + i), m);\n"
        "float c = k;\n"
        "for (uint pass = 0u; pass < mostSteps; ++pass) {\n"
        "    float total = 0.0, squares = 0.0;\n"
        "    for (uint i = atFields; i < count; ++i) {\n"
        "        float t = max(0.0, c - (arg(first + i) - m));\n"
        "        total += t;\n"
        "        squares += t * t;\n"
        "    }\n"
        "    float next = c - (squares - k * k) / max(total + total, 1e-30);\n"
        "    if (!(next < c)) break;\n"
        "    c = next;\n"
        "}\n"
        "return m - (k - c);";

    template <class V>
    static V apply(std::span<const V> args, uint32_t) {
        const auto field = [&](size_t i) { return args[i]; };
        const Solution<V> s = solve(args.size(), args[0], field);
        return smoothMin(s, args[0]);
    }

    /// f falls with k and rises with every field. Sums of n squares are off by n ulps, which moves c' by n/2 ulps of k
    /// at most; the differences to m by one of k, the result by one of m.
    template <class I>
    static I interval(std::span<const I> args, uint32_t) {
        using V = typename I::Value;
        const V kLo = args[0].lo, kHi = args[0].hi;
        const Solution<V> low = solve(args.size(), kHi, [&](size_t i) { return args[i].lo; });
        const Solution<V> high = solve(args.size(), kLo, [&](size_t i) { return args[i].hi; });
        const float ulps = 2e-7f * static_cast<float>(args.size() + 8);
        return I{smoothMin(low, kHi) - (abs(low.least) * 4e-7f + kHi * ulps),
                 min(smoothMin(high, kLo) + (abs(high.least) * 4e-7f + kLo * ulps), high.least)};
    }

    /// Implicit differentiation: ∂f/∂fᵢ = tᵢ / Σt with tᵢ = max(0, c' − dᵢ), and ∂f/∂k = k / Σt − 1.
    template <class D>
    static D gradient(std::span<const D> args, uint32_t data) {
        return gradientOf<false>(args, data);
    }
    /// With `exact`, where no field but the least counts, its derivatives bit for bit.
    template <bool exact, class D>
    static D gradientOf(std::span<const D> args, uint32_t) {
        using V = typename D::Value;
        const D k = args[0];
        const Solution<V> s = solve(args.size(), k.value, [&](size_t i) { return args[i].value; });
        D least = args[1];
        V dx = 0.0f, dy = 0.0f, dz = 0.0f, total = 0.0f;
        for (size_t i = 1; i < args.size(); ++i) {
            const D& a = args[i];
            const V t = max(V(0.0f), s.c - (a.value - s.least));
            dx = dx + t * a.dx;
            dy = dy + t * a.dy;
            dz = dz + t * a.dz;
            total = total + t;
            least = min(a, least);
        }
        const auto soft = total > (exact ? s.c : V(0.0f));
        const V weight = V(1.0f) / select(soft, total, V(1.0f)), slope = k.value * weight - V(1.0f);
        return D{smoothMin(s, k.value), select(soft, dx * weight + k.dx * slope, least.dx),
                 select(soft, dy * weight + k.dy * slope, least.dy),
                 select(soft, dz * weight + k.dz * slope, least.dz)};
    }

    /// Field i is out when fᵢ − m ≥ k for certain, however that is rounded.
    template <class I>
    static auto pruneBound(std::span<const I> args, uint32_t) {
        using V = typename I::Value;
        V least = args[1].hi;
        for (size_t i = 2; i < args.size(); ++i) least = min(args[i].hi, least);
        return (least + args[0].hi) + (abs(least) + args[0].hi) * 4e-7f;
    }

    /// Of a blend f = c − k with the least operand m, where m − k ≤ f ≤ m and an operand counts below m + k alone:
    /// those above most + 2k don't where f ≤ most, and elsewhere leave f above it. The rest is for rounding.
    static RelevantRange shownBy(RelevantRange relevant, OperandRange k) {
        const float twice = 2 * k.lo;
        if (!k.isNumber || !(twice >= 0)) return {};
        return {relevant.least, relevant.most + twice + 1e-5f * (std::abs(relevant.most) + twice)};
    }

private:
    template <class V>
    struct Solution {
        V least, c;  ///< m and c'
    };

    /// In this form −0 stays −0 when nothing blends.
    template <class V>
    static V smoothMin(const Solution<V>& s, const V& k) {
        return s.least - (k - s.c);
    }

    /// `field(i)` for i in [1, count). Lanes that have converged no longer move, so their bits don't depend on the
    /// others.
    template <class V, class Get>
    static Solution<V> solve(size_t count, const V& k, const Get& field) {
        V m = field(1);
        for (size_t i = 2; i < count; ++i) m = min(field(i), m);
        V c = k;
        for (int step = 0; step < maxSteps; ++step) {
            V total = 0.0f, squares = 0.0f;
            for (size_t i = 1; i < count; ++i) {
                const V t = max(V(0.0f), c - (field(i) - m));
                total = total + t;
                squares = squares + t * t;
            }
            const V next = c - (squares - k * k) / max(total + total, V(1e-30f));
            const auto falls = next < c;
            if (!any(falls)) break;
            c = select(falls, next, c);
        }
        return {m, c};
    }
};

}  // namespace sgm::field::ops
