// The kaleidoscopic iterated function system (KIFS) as an op: McGraw, "Interactive generation of buildings…", algorithm 1,
// with the errata of docs/papers.md.
// Enters: operands in the order of `Kifs::Operand` and `data` from `Kifs::pack`. Leaves: a bound of the distance to the
// fractal. Assumes scale > 1 and rotations that are rotations.
// One pass: turn (R₁), the folds of the Menger sponge (|x|, sort descending), fold (R₂), scale about the centre, and the
// last fold in z. In the continuous form every step but the scaling is an isometry or a reflection, so the value, divided
// by the product of the scales, is exactly 1-Lipschitz. The jump form (z − 2h for z > h, as printed) gives the same values
// when R₁ = I and is discontinuous otherwise; so is any bailout.
#pragma once

#include <limits>
#include <span>
#include <string_view>

#include "modeler/field/values.h"

namespace sgm::field::ops {

struct Kifs {
    static constexpr std::string_view name = "kifs";
    static constexpr int arity = variadic;
    static constexpr size_t moving = 3;

    /// Places of the operands; vectors take three, rotations nine (by columns).
    enum Operand : size_t { position, centreOfScale = 3, scale = 6, fold = 7, turn = 16, bailout = 25, operandCount };

    /// What of a node is structure.
    struct Form {
        uint32_t passes = 6;  ///< 1 … 255
        bool cube = false;    ///< terminal solid: the cube of the centre's largest component, or the ball of radius 2
        bool jump = false;    ///< as printed, instead of the continuous fold
        bool bails = false;   ///< stop where the squared radius exceeds the bailout
        bool folds = true;    ///< false: R₂ = I and its operands are not read
        bool turns = true;    ///< the same for R₁
        constexpr bool continuous() const { return !bails && !(jump && turns); }
    };
    static constexpr uint32_t pack(const Form& f) {
        return f.passes | (f.cube ? 256u : 0u) | (f.jump ? 512u : 0u) | (f.bails ? 1024u : 0u) |
               (f.folds ? 2048u : 0u) | (f.turns ? 4096u : 0u);
    }
    static constexpr Form unpack(uint32_t d) {
        return {d & 255u, (d & 256u) != 0, (d & 512u) != 0, (d & 1024u) != 0, (d & 2048u) != 0, (d & 4096u) != 0};
    }

    static constexpr std::string_view glsl =
        "vec3 p = vec3(arg(first), arg(first + 1u), arg(first + 2u));\n"
        "vec3 c = vec3(arg(first + 3u), arg(first + 4u), arg(first + 5u));\n"
        "float s = arg(first + 6u), scales = 1.0;\n"
        "mat3 r2 = mat3(1.0), r1 = mat3(1.0);\n"
        "for (uint i = 0u; i < 9u; ++i) {\n"
        "    if ((data & 2048u) != 0u) r2[i / 3u][i % 3u] = arg(first + 7u + i);\n"
        "    if ((data & 4096u) != 0u) r1[i / 3u][i % 3u] = arg(first + 16u + i);\n"
        "}\n"
        "float limit = arg(first + 25u), h = c.z * (s - 1.0) * 0.5;\n"
        "for (uint pass = 0u; pass < (data & 255u); ++pass) {\n"
        "    p = abs(r1 * p);\n"
        "    p.xy = vec2(max(p.x, p.y), min(p.x, p.y));\n"
        "    p.xz = vec2(max(p.x, p.z), min(p.x, p.z));\n"
        "    p.yz = vec2(max(p.y, p.z), min(p.y, p.z));\n"
        "    p = r2 * p * s;\n"
        "    p.xy -= c.xy * (s - 1.0);\n"
        "    p.z = (data & 512u) == 0u ? h - abs(p.z - h) : p.z > h ? p.z - (h + h) : p.z;\n"
        "    scales *= s;\n"
        "    if ((data & 1024u) != 0u && dot(p, p) > limit) break;\n"
        "}\n"
        "vec3 q = abs(p);\n"
        "float d = (data & 256u) != 0u ? max(max(q.x, q.y), q.z) - max(max(c.x, c.y), c.z) : length(p) - 2.0;\n"
        "return d / scales;";

    template <class V>
    static V apply(std::span<const V> args, uint32_t data) {
        const Form form = unpack(data);
        State<V> at = start(args);
        for (uint32_t i = 0; i < form.passes; ++i) {
            State<V> next = isometries(at, args, form);
            const V h = lastFold(args);
            next.z = form.jump ? select(next.z > h, next.z - (h + h), next.z) : h - abs(next.z - h);
            if (!form.bails) {
                at = next;
                continue;
            }
            const V limit = i == 0 ? V(std::numeric_limits<float>::infinity()) : args[bailout];
            const auto moves = dot(at) <= limit;
            at = {select(moves, next.x, at.x), select(moves, next.y, at.y), select(moves, next.z, at.z),
                  select(moves, next.scales, at.scales)};
            if (!any(moves)) break;
        }
        return terminal(at, args, form);
    }

    /// With fixed parameters and a continuous form: f(centre) ± the radius of the box, not below the terminal solid's depth.
    /// Otherwise the passes over intervals.
    template <class I>
    static I interval(std::span<const I> args, uint32_t data) {
        using V = typename I::Value;
        const Form form = unpack(data);
        V middle[operandCount], spread = 0.0f;
        for (size_t i = 0; i < operandCount; ++i) middle[i] = i < centreOfScale ? centre(args[i]) : args[i].lo;
        for (size_t i = centreOfScale; i < operandCount; ++i) spread = max(args[i].hi - args[i].lo, spread);
        if (!form.continuous() || any(!(spread <= V(0.0f)))) return passesOver(args, form);

        const V rx = radius(args[0]), ry = radius(args[1]), rz = radius(args[2]);
        const V* c = middle + centreOfScale;
        // A pass rounds by a few ulps of the coordinates before it, which the scales divide again.
        const V size = abs(middle[0]) + abs(middle[1]) + abs(middle[2]) + abs(c[0]) + abs(c[1]) + abs(c[2]) + V(2.0f);
        const V ulps = size * (1e-6f * static_cast<float>(form.passes + 1));
        const V reach = sqrt(rx * rx + ry * ry + rz * rz) * 1.00001f + ulps;
        const V value = apply<V>(middle, data);
        V scales = 1.0f;
        for (uint32_t i = 0; i < form.passes; ++i) scales = scales * middle[scale];
        const V deepest = (form.cube ? -max(max(c[0], c[1]), c[2]) : V(-2.0f)) / scales * V(1.00001f);
        return I{max(deepest, value - reach), value + reach};  // NaN, as the second operand, survives
    }

private:
    /// A point on its way through the passes, and the product of the scales so far.
    template <class V>
    struct State {
        V x, y, z, scales;
    };

    template <class V>
    static State<V> start(std::span<const V> args) {
        return {args[position], args[position + 1], args[position + 2], V(1.0f)};
    }

    template <class V>
    static V dot(const State<V>& p) {
        const V x = abs(p.x), y = abs(p.y), z = abs(p.z);  // so that an interval's squares aren't negative
        return x * x + y * y + z * z;
    }

    /// Half the distance between the two copies along z.
    template <class V>
    static V lastFold(std::span<const V> args) {
        return args[centreOfScale + 2] * (args[scale] - V(1.0f)) * V(0.5f);
    }

    /// The rotation in the nine operands from `first`, by columns.
    template <class V>
    static State<V> rotated(const State<V>& p, std::span<const V> args, size_t first) {
        const auto row = [&](size_t r) {
            return args[first + r] * p.x + args[first + 3 + r] * p.y + args[first + 6 + r] * p.z;
        };
        return {row(0), row(1), row(2), p.scales};
    }

    /// One pass up to the last fold.
    template <class V>
    static State<V> isometries(State<V> p, std::span<const V> args, const Form& form) {
        if (form.turns) p = rotated(p, args, turn);
        const V x = abs(p.x), y = abs(p.y), z = abs(p.z);
        const V xy = max(x, y), yx = min(x, y);
        const V first = max(xy, z), rest = min(xy, z);
        State<V> q{first, max(yx, rest), min(yx, rest), p.scales};
        if (form.folds) q = rotated(q, args, fold);
        const V s = args[scale], less = s - V(1.0f);
        return {q.x * s - args[centreOfScale] * less, q.y * s - args[centreOfScale + 1] * less, q.z * s, q.scales * s};
    }

    template <class V>
    static V terminal(const State<V>& p, std::span<const V> args, const Form& form) {
        const V* c = &args[centreOfScale];
        if (form.cube) return (max(max(abs(p.x), abs(p.y)), abs(p.z)) - max(max(c[0], c[1]), c[2])) / p.scales;
        return (sqrt(dot(p)) - V(2.0f)) / p.scales;
    }

    /// The natural extension: wide, but it holds for parameters that vary, for jumps and for bailouts.
    template <class I>
    static I passesOver(std::span<const I> args, const Form& form) {
        using V = typename I::Value;
        State<I> at = start(args);
        V lo = std::numeric_limits<float>::infinity(), hi = -std::numeric_limits<float>::infinity();
        for (uint32_t i = 0; i < form.passes; ++i) {
            at = isometries(at, args, form);
            const I h = lastFold(args);
            if (form.jump) {
                const auto may = at.z.hi > h.lo, must = at.z.lo > h.hi;
                const I moved = at.z - (h + h);
                at.z = {select(must, moved.lo, select(may, min(moved.lo, at.z.lo), at.z.lo)),
                        select(must, moved.hi, select(may, max(moved.hi, at.z.hi), at.z.hi))};
            } else {
                at.z = h - abs(at.z - h);
            }
            if (form.bails) {
                const I early = terminal(at, args, form);
                const auto leaves = dot(at).hi > args[bailout].lo;
                lo = select(leaves, min(early.lo, lo), lo);
                hi = select(leaves, max(early.hi, hi), hi);
            }
        }
        const I last = terminal(at, args, form);
        return {min(lo, last.lo), max(hi, last.hi)};
    }
};

}  // namespace sgm::field::ops
