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
        return distance(args[position], args[position + 1], args[position + 2], args, unpack(data));
    }

    /// The value at (x, y, z); of `args` only the parameters are read, at their places.
    template <class V>
    static V distance(const V& x, const V& y, const V& z, std::span<const V> args, const Form& form) {
        State<V> at{x, y, z, V(1.0f)};
        walk(at, args, form, [](uint32_t) { return Unkept{}; });
        return terminal(at, args, form);
    }

    /// Where the parameters are numbers: back through the passes from the terminal solid's normal. Each turns and reflects
    /// it; the scaling of the passes is divided out again at the end.
    template <class D>
    static D gradientByNumbers(std::span<const D> args, uint32_t data) {
        using V = typename D::Value;
        constexpr uint32_t mostPasses = 16;
        const Form form = unpack(data);
        if (form.passes > mostPasses) return apply<D>(args, data);
        V numbers[operandCount];
        for (size_t i = 0; i < operandCount; ++i) numbers[i] = args[i].value;
        const std::span<const V> all(numbers, operandCount);
        Kept<V> kept[mostPasses];
        State<V> at = start(all);
        const uint32_t passes = walk(at, all, form, [&](uint32_t i) -> Kept<V>& { return kept[i]; });
        State<V> g = normal(at, form);
        for (uint32_t i = passes; i-- > 0;) {
            const State<V> before = kept[i].back(g, all, form);
            if (form.bails)
                g = chosen(kept[i].moves, before, g);
            else
                g = before;
        }
        const D &x = args[position], &y = args[position + 1], &z = args[position + 2];
        return D{terminal(at, all, form), g.x * x.dx + g.y * y.dx + g.z * z.dx, g.x * x.dy + g.y * y.dy + g.z * z.dy,
                 g.x * x.dz + g.y * y.dz + g.z * z.dz};
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

    /// Which way a pass went, for the way back.
    template <class V>
    struct Kept {
        MaskOf<V> negX, negY, negZ, xy, z, rest, low, moves;

        void signs(const State<V>& p) { negX = p.x < V(0.0f), negY = p.y < V(0.0f), negZ = p.z < V(0.0f); }
        void order(const V& x, const V& y, const V& mostXy, const V& z0, const V& leastXy, const V& leastZ) {
            xy = x > y, z = mostXy > z0, rest = leastXy > leastZ;
        }
        void fold(const V& offset) { low = offset < V(0.0f); }
        void move(const MaskOf<V>& m) { moves = m; }

        /// The derivatives before the pass from those after it.
        State<V> back(State<V> g, std::span<const V> args, const Form& form) const {
            if (!form.jump) g.z = select(low, g.z, -g.z);
            if (form.folds) g = turnedBack(g, args, Kifs::fold);
            const V yx = select(rest, g.y, g.z), leastZ = select(rest, g.z, g.y);
            const V most = select(z, g.x, leastZ), gz = select(z, leastZ, g.x);
            const V gx = select(xy, most, yx), gy = select(xy, yx, most);
            g = {select(negX, -gx, gx), select(negY, -gy, gy), select(negZ, -gz, gz), g.scales};
            return form.turns ? turnedBack(g, args, Kifs::turn) : g;
        }
    };
    struct Unkept {
        void signs(const auto&) {}
        void order(const auto&...) {}
        void fold(const auto&) {}
        void move(const auto&) {}
    };

    template <class V>
    static State<V> chosen(const MaskOf<V>& mask, const State<V>& a, const State<V>& b) {
        return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z),
                select(mask, a.scales, b.scales)};
    }

    /// Takes `at` through the passes; keep(i) is told which way pass i went. Returns how many were begun.
    template <class V, class Keep>
    static uint32_t walk(State<V>& at, std::span<const V> args, const Form& form, const Keep& keep) {
        for (uint32_t i = 0; i < form.passes; ++i) {
            auto&& kept = keep(i);
            State<V> next = isometries(at, args, form, kept);
            const V h = lastFold(args);
            if (form.jump) {
                next.z = select(next.z > h, next.z - (h + h), next.z);
            } else {
                const V offset = next.z - h;
                kept.fold(offset);
                next.z = h - abs(offset);
            }
            if (!form.bails) {
                at = next;
                continue;
            }
            const V limit = i == 0 ? V(std::numeric_limits<float>::infinity()) : args[bailout];
            const auto moves = dot(at) <= limit;
            kept.move(moves);
            at = chosen<V>(moves, next, at);
            if (!any(moves)) return i + 1;
        }
        return form.passes;
    }

    /// Derivatives of the terminal solid's distance.
    template <class V>
    static State<V> normal(const State<V>& p, const Form& form) {
        const V zero = 0.0f;
        if (!form.cube) {
            const V length = sqrt(dot(p));
            const auto off = length > zero;
            const V share = select(off, V(1.0f) / select(off, length, V(1.0f)), zero);
            return {p.x * share, p.y * share, p.z * share, p.scales};
        }
        const V x = abs(p.x), y = abs(p.y), z = abs(p.z);
        const auto inX = (x >= y) & (x >= z), inY = y >= z;
        const auto side = [&](const V& v) { return select(v < zero, V(-1.0f), V(1.0f)); };
        return {select(inX, side(p.x), zero), select(inX, zero, select(inY, side(p.y), zero)),
                select(inX | inY, zero, side(p.z)), p.scales};
    }

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

    /// The inverse rotation.
    template <class V>
    static State<V> turnedBack(const State<V>& p, std::span<const V> args, size_t first) {
        const auto column = [&](size_t c) {
            return args[first + 3 * c] * p.x + args[first + 3 * c + 1] * p.y + args[first + 3 * c + 2] * p.z;
        };
        return {column(0), column(1), column(2), p.scales};
    }

    /// One pass up to the last fold.
    template <class V, class Keep>
    static State<V> isometries(State<V> p, std::span<const V> args, const Form& form, Keep&& kept) {
        if (form.turns) p = rotated(p, args, turn);
        kept.signs(p);
        const V x = abs(p.x), y = abs(p.y), z = abs(p.z);
        const V xy = max(x, y), yx = min(x, y);
        const V first = max(xy, z), rest = min(xy, z);
        kept.order(x, y, xy, z, yx, rest);
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
            at = isometries(at, args, form, Unkept{});
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
