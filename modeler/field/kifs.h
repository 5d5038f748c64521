// The kaleidoscopic iterated function system (KIFS) as an op: McGraw, "Interactive generation of buildings…", algorithm
// 1, with the errata of docs/papers.md. Enters: operands in the order of `Kifs::Operand` and `data` from `Kifs::pack`.
// Leaves: a bound of the distance to the fractal. Assumes scale > 1 and rotations that are rotations. One pass: turn
// (R₁), the folds of the Menger sponge (|x|, sort descending), fold (R₂), scale about the centre, and the last fold in
// z. In the continuous form every step but the scaling is an isometry or a reflection, so the value, divided by the
// product of the scales, is exactly 1-Lipschitz. The jump form (z − 2h for z > h, as printed) gives the same values
// when R₁ = I and is discontinuous otherwise; so is any bailout.
#pragma once

#include <limits>
#include <span>
#include <string_view>
#include <type_traits>

#include "modeler/field/kifs_form.h"
#include "modeler/field/kifs_glsl.h"
#include "modeler/field/values.h"

namespace sgm::field::ops {

struct Kifs : KifsForm {
    static constexpr std::string_view name = "kifs";
    static constexpr int arity = variadic;
    static constexpr size_t varyingOperands = 3;

    static constexpr std::string_view glsl = kifsGlsl;

    /// Forms told apart where code is made, so that nothing is asked on the way through the passes.
    enum class Path { Plain, Folds, Turns, Both, Jumps };
    /// visit.operator()<path>() for the path of a form.
    static constexpr void visitPath(const Form& form, auto&& visit) {
        if (form.jump || form.bails)
            visit.template operator()<Path::Jumps>();
        else if (form.folds)
            form.turns ? visit.template operator()<Path::Both>() : visit.template operator()<Path::Folds>();
        else
            form.turns ? visit.template operator()<Path::Turns>() : visit.template operator()<Path::Plain>();
    }

    template <Path path>
    static constexpr bool folds(const Form& f) {
        return path == Path::Jumps ? f.folds : path == Path::Folds || path == Path::Both;
    }
    template <Path path>
    static constexpr bool turns(const Form& f) {
        return path == Path::Jumps ? f.turns : path == Path::Turns || path == Path::Both;
    }

    /// What the passes take from the parameters: to be made once for all points, where those are numbers.
    template <class V>
    struct Folds {
        Form form;
        V scale, lastFold, moveX, moveY, limit, reach, unscale;
        V fold[9], turn[9];  ///< rotations by columns, the fold's scaled

        /// Of `args` the parameters are read, at their places.
        [[gnu::always_inline]] Folds(std::span<const V> args, uint32_t data)
            : form(unpack(data)), scale(args[Kifs::scale]), limit(args[bailout]) {
            const V* const c = &args[centreOfScale];
            const V less = scale - V(1.0f);
            lastFold = c[2] * less * V(0.5f);  // half the distance between the two copies along z
            moveX = c[0] * less, moveY = c[1] * less;
            reach = form.cube ? max(max(c[0], c[1]), c[2]) : V(2.0f);
            V scales = scale;
            for (uint32_t i = 1; i < form.passes; ++i) scales = scales * scale;
            unscale = V(1.0f) / scales;
            for (size_t i = 0; form.folds && i < 9; ++i) fold[i] = args[Kifs::fold + i] * scale;
            for (size_t i = 0; form.turns && i < 9; ++i) turn[i] = args[Kifs::turn + i];
        }
    };

    /// The same with the stretch.
    template <class V>
    struct UniformParams : Folds<V> {
        V stretch[3];
        [[gnu::always_inline]] UniformParams(std::span<const V> args, uint32_t data) : Folds<V>(args, data) {
            for (size_t i = 0; i < 3; ++i) stretch[i] = args[Kifs::stretch + i];
        }
    };

    template <class V>
    static V apply(std::span<const V> args, uint32_t data) {
        const UniformParams<V> numbers(args, data);
        V value;
        visitPath(numbers.form, [&]<Path path>() { value = evalUniform<path>(args.data(), numbers); });
        return value;
    }

    /// The value at a point, by numbers that are V themselves or plain floats; with derivatives where V has them and
    /// the numbers have none.
    template <Path path, class V, class W>
    [[gnu::always_inline]] static V evalUniform(const V* at, const UniformParams<W>& numbers) {
        const auto stretched = [&](size_t i) {
            if constexpr (std::is_same_v<NumberOf<V, W>, V>) {
                return at[i] * V(numbers.stretch[i]);
            } else {
                const NumberOf<V, W> by = numbers.stretch[i];
                return V{at[i].value * by, at[i].dx * by, at[i].dy * by, at[i].dz * by};
            }
        };
        const V p[] = {stretched(0), stretched(1), stretched(2)};
        return folded<path>(p, numbers);
    }
    /// The same of a point that is stretched already, or needn't be.
    template <Path path, class V, class W>
    [[gnu::always_inline]] static V folded(const V* at, const Folds<W>& folds) {
        if constexpr (!std::is_same_v<NumberOf<V, W>, V>) {
            return gradient<path>(at[0], at[1], at[2], folds);
        } else {
            State<V> p{at[0], at[1], at[2], V(1.0f)};
            walk<path>(p, folds, [](uint32_t) { return Unkept{}; });
            return terminal(p, folds);
        }
    }

    /// What a number W is beside a V: a V, without its derivatives where the W has none.
    template <class V, class W>
    struct Beside {
        using Type = V;
    };
    template <class V, class W>
    requires(!std::is_same_v<V, W>) && requires { typename V::Value; }
    struct Beside<V, W> {
        using Type = typename V::Value;
    };
    template <class V, class W>
    using NumberOf = typename Beside<V, W>::Type;

    /// With fixed parameters and a continuous form: f(centre) ± the radius of the box, not below the terminal solid's
    /// depth. Otherwise the passes over intervals.
    template <class I>
    static I interval(std::span<const I> args, uint32_t data) {
        using V = typename I::Value;
        const Form form = unpack(data);
        V middle[operandCount], spread = 0.0f;
        const I at[] = {args[0] * args[stretch], args[1] * args[stretch + 1], args[2] * args[stretch + 2]};
        for (size_t i = 0; i < operandCount; ++i) middle[i] = i < centreOfScale ? centre(at[i]) : args[i].lo;
        for (size_t i = centreOfScale; i < operandCount; ++i) spread = max(args[i].hi - args[i].lo, spread);
        if (!form.continuous() || any(!(spread <= V(0.0f)))) return passesOver(at, args, data);

        const V rx = radius(at[0]), ry = radius(at[1]), rz = radius(at[2]);
        const V* c = middle + centreOfScale;
        // A pass rounds by a few ulps of the coordinates before it, which the scales divide again.
        const V size = abs(middle[0]) + abs(middle[1]) + abs(middle[2]) + abs(c[0]) + abs(c[1]) + abs(c[2]) + V(2.0f);
        const V ulps = size * (1e-6f * static_cast<float>(form.passes + 1));
        const V reach = sqrt(rx * rx + ry * ry + rz * rz) * 1.00001f + ulps;
        const Folds<V> folds(std::span<const V>(middle, operandCount), data);
        V value;
        visitPath(form, [&]<Path path>() { value = folded<path>(middle, folds); });
        const V deepest = -folds.reach * folds.unscale * V(1.00001f);
        // Nothing is known where a pass might overflow, for its values are then.
        const auto fits = size + reach <= folds.unscale * V(1e30f);
        return I{max(deepest, value - reach), value + reach}.where(fits);  // NaN, as the second operand, survives
    }

private:
    /// A point on its way through the passes, and the product of the scales so far, which only a bailout asks for.
    template <class V>
    struct State {
        V x, y, z, scales;
    };

    /// What tells which way a pass went, for the way back: its point before the folds, and before the last one. Masks
    /// would say the same in less room, but take longer to store and to fetch.
    template <class V>
    struct Kept {
        V x, y, z, offset;
        MaskOf<V> moves;

        void point(const V& px, const V& py, const V& pz) { x = px, y = py, z = pz; }
        void fold(const V& o) { offset = o; }
        void move(const MaskOf<V>& m) { moves = m; }

        /// The derivatives before the pass from those after it, scaled where the pass has a rotation that does.
        template <Path path, class W>
        [[gnu::always_inline]] void back(V& gx, V& gy, V& gz, const Folds<W>& n) const {
            const V zero = 0.0f;
            if (path != Path::Jumps || !n.form.jump) gz = select(offset < zero, gz, -gz);
            if (folds<path>(n.form)) rotateBack(gx, gy, gz, n.fold);
            const V ax = abs(x), ay = abs(y), az = abs(z), least = min(ax, ay), most = max(ax, ay);
            const auto xy = ax > ay, top = most > az, rest = least > min(most, az);
            const V second = select(rest, gy, gz), third = select(rest, gz, gy);
            const V first = select(top, gx, third), last = select(top, third, gx);
            const V right = select(xy, first, second), up = select(xy, second, first);
            gx = select(x < zero, -right, right);
            gy = select(y < zero, -up, up);
            gz = select(z < zero, -last, last);
            if (turns<path>(n.form)) rotateBack(gx, gy, gz, n.turn);
        }
    };
    struct Unkept {
        void point(const auto&, const auto&, const auto&) {}
        void fold(const auto&) {}
        void move(const auto&) {}
    };

    /// The same with derivatives: back through the passes from the terminal solid's normal, which each of them turns
    /// and reflects.
    template <Path path, class D, class W>
    [[gnu::always_inline]] static D gradient(const D& x, const D& y, const D& z, const Folds<W>& numbers) {
        using V = typename D::Value;
        constexpr uint32_t mostPasses = 255;
        Kept<V> kept[mostPasses];
        State<V> at{x.value, y.value, z.value, V(1.0f)};
        const uint32_t passes = walk<path>(at, numbers, [&](uint32_t i) -> Kept<V>& { return kept[i]; });
        const State<V> g = normal(at, numbers.form);
        V gx = g.x, gy = g.y, gz = g.z;
        if (folds<path>(numbers.form)) {  // their rotations scale
            const V share = path == Path::Jumps && numbers.form.bails ? V(1.0f) / at.scales : V(numbers.unscale);
            gx = gx * share, gy = gy * share, gz = gz * share;
        }
        for (uint32_t i = passes; i-- > 0;) {
            const V afterX = gx, afterY = gy, afterZ = gz;
            kept[i].template back<path>(gx, gy, gz, numbers);
            if (path != Path::Jumps || !numbers.form.bails) continue;
            gx = select(kept[i].moves, gx, afterX);
            gy = select(kept[i].moves, gy, afterY);
            gz = select(kept[i].moves, gz, afterZ);
        }
        return D{terminal(at, numbers), gx * x.dx + gy * y.dx + gz * z.dx, gx * x.dy + gy * y.dy + gz * z.dy,
                 gx * x.dz + gy * y.dz + gz * z.dz};
    }

    template <class V>
    static State<V> chosen(const MaskOf<V>& mask, const State<V>& a, const State<V>& b) {
        return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z),
                select(mask, a.scales, b.scales)};
    }

    /// Takes `at` through the passes; keep(i) is told which way pass i went. Returns how many were begun.
    template <Path path, class V, class W, class Keep>
    [[gnu::always_inline]] static uint32_t walk(State<V>& at, const Folds<W>& n, const Keep& keep) {
        if constexpr (path == Path::Jumps) return walkWithLeaps(at, n, keep);
        V x = at.x, y = at.y, z = at.z;  // by themselves: a compiler keeps those in registers
        for (uint32_t i = 0; i < n.form.passes; ++i) {
            auto&& kept = keep(i);
            foldAndScale<path>(x, y, z, n, kept);
            const V offset = z - n.lastFold;
            kept.fold(offset);
            z = n.lastFold - abs(offset);
        }
        at = {x, y, z, at.scales};
        return n.form.passes;
    }
    template <class V, class W, class Keep>
    static uint32_t walkWithLeaps(State<V>& at, const Folds<W>& n, const Keep& keep) {
        for (uint32_t i = 0; i < n.form.passes; ++i) {
            auto&& kept = keep(i);
            State<V> next = at;
            foldAndScale<Path::Jumps>(next.x, next.y, next.z, n, kept);
            const V h = n.lastFold;
            if (n.form.jump) {
                next.z = select(next.z > h, next.z - (h + h), next.z);
            } else {
                const V offset = next.z - h;
                kept.fold(offset);
                next.z = h - abs(offset);
            }
            if (!n.form.bails) {
                at = next;
                continue;
            }
            next.scales = at.scales * n.scale;
            const V limit = i == 0 ? V(std::numeric_limits<float>::infinity()) : V(n.limit);
            const auto moves = dot(at) <= limit;
            kept.move(moves);
            at = chosen<V>(moves, next, at);
            if (!any(moves)) return i + 1;
        }
        return n.form.passes;
    }

    /// Derivatives of the terminal solid's distance.
    template <class V>
    [[gnu::always_inline]] static State<V> normal(const State<V>& p, const Form& form) {
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
    static V dot(const State<V>& p) {
        const V x = abs(p.x), y = abs(p.y), z = abs(p.z);  // so that an interval's squares aren't negative
        return x * x + y * y + z * z;
    }

    /// The linear map by columns.
    template <class V, class W>
    [[gnu::always_inline]] static void rotate(V& x, V& y, V& z, const W m[9]) {
        const V px = x, py = y, pz = z;
        const auto row = [&](size_t r) { return m[r] * px + m[3 + r] * py + m[6 + r] * pz; };
        x = row(0), y = row(1), z = row(2);
    }
    /// Its transpose: the inverse of a rotation.
    template <class V, class W>
    [[gnu::always_inline]] static void rotateBack(V& x, V& y, V& z, const W m[9]) {
        const V px = x, py = y, pz = z;
        const auto column = [&](size_t c) { return m[3 * c] * px + m[3 * c + 1] * py + m[3 * c + 2] * pz; };
        x = column(0), y = column(1), z = column(2);
    }

    /// One pass up to the last fold.
    template <Path path, class V, class W, class Keep>
    [[gnu::always_inline]] static void foldAndScale(V& x, V& y, V& z, const Folds<W>& n, Keep&& kept) {
        if (turns<path>(n.form)) rotate(x, y, z, n.turn);
        kept.point(x, y, z);
        const V ax = abs(x), ay = abs(y), az = abs(z);
        const V xy = max(ax, ay), yx = min(ax, ay), rest = min(xy, az);
        x = max(xy, az), y = max(yx, rest), z = min(yx, rest);
        if (folds<path>(n.form))
            rotate(x, y, z, n.fold);
        else
            x = x * n.scale, y = y * n.scale, z = z * n.scale;
        x = x - n.moveX, y = y - n.moveY;
    }

    template <class V, class W>
    [[gnu::always_inline]] static V terminal(const State<V>& p, const Folds<W>& n) {
        const V size = n.form.cube ? max(max(abs(p.x), abs(p.y)), abs(p.z)) : sqrt(dot(p));
        return n.form.bails ? (size - n.reach) / p.scales : (size - n.reach) * n.unscale;
    }

    /// The natural extension: wide, but it holds for parameters that vary, for jumps and for bailouts.
    template <class I>
    static I passesOver(const I* p, std::span<const I> args, uint32_t data) {
        using V = typename I::Value;
        const Folds<I> n(args, data);
        const Form& form = n.form;
        State<I> at{p[0], p[1], p[2], I(1.0f)};
        V lo = std::numeric_limits<float>::infinity(), hi = -std::numeric_limits<float>::infinity();
        for (uint32_t i = 0; i < form.passes; ++i) {
            foldAndScale<Path::Jumps>(at.x, at.y, at.z, n, Unkept{});
            const I& h = n.lastFold;
            if (form.jump) {
                const auto may = at.z.hi > h.lo, must = at.z.lo > h.hi;
                const I moved = at.z - (h + h);
                at.z = {select(must, moved.lo, select(may, min(moved.lo, at.z.lo), at.z.lo)),
                        select(must, moved.hi, select(may, max(moved.hi, at.z.hi), at.z.hi))};
            } else {
                at.z = h - abs(at.z - h);
            }
            if (form.bails) {
                at.scales = at.scales * n.scale;
                const I early = terminal(at, n);
                const auto leaves = dot(at).hi > n.limit.lo;
                lo = select(leaves, min(early.lo, lo), lo);
                hi = select(leaves, max(early.hi, hi), hi);
            }
        }
        const I last = terminal(at, n);
        return {min(lo, last.lo), max(hi, last.hi)};
    }
};

}  // namespace sgm::field::ops
