// A facade of KIFS cells as an op: McGraw, eq. 4 and algorithm 2, with the errata of docs/papers.md.
// Enters: a position in metres from the origin of the tiling (x along the walls, y up, z across), the distances to the
// outer and the inner shell, and numbers from modeler/field/facade.cpp. Leaves: a bound of the distance to the infinite
// facade, at most `most`; exactly `most` where a shell decides anyway (outer ≥ most or inner ≤ −deepest), so that the
// fractal costs nothing there. Assumes the continuous form of the fractal.
// Space is cut into cells: storeys in y, and in x and z the bays of one facade id, which the paper's folds make of half
// a period. Inside a cell the map is continuous; from cell to cell it jumps. The field is the least over all cells of
// max(distance to the cell's fractal, distance to the cell's slab): the same solid, but 1-Lipschitz. A slab reaches
// `slack` over its border, so that no surface stays between two cells that are full there.
#pragma once

#include <limits>
#include <span>
#include <string_view>
#include <type_traits>

#include "modeler/field/kifs.h"

namespace sgm::field::ops {

struct Facade {
    static constexpr std::string_view name = "facade";
    static constexpr int arity = variadic;
    static constexpr size_t varyingOperands = 5;
    /// Three folds cut half a period into no more pieces.
    static constexpr size_t mostBays = 14;

    static constexpr size_t fractalCount = size_t{Kifs::bailout} - size_t{Kifs::centreOfScale};
    /// Places of the operands; the fractal's parameters lie as in Kifs, from its centre to its turn.
    enum Operand : size_t {
        position,
        outer = 3,                        ///< distance to the outer shell
        inner,                            ///< distance to the inner shell
        fractal,                          ///< from the centre of scaling to the turn
        period = fractal + fractalCount,  ///< along x and along z, metres
        shrink = period + 2,              ///< least world length of a metre of x, of z
        mirrors = shrink + 2,             ///< r₁ r₂ r₃
        storey = mirrors + 3,             ///< height, metres
        storeys,                          ///< how many
        rise,                             ///< s_y
        most,
        deepest,
        slack,
        rounding,
        bays,  ///< of each: where it begins in half a period (0 … 1; `noBay` for none), scale and shift
        operandCount = bays + 3 * mostBays
    };

    static constexpr float noBay = 3;
    static constexpr uint32_t pack(const Kifs::Form& form) { return Kifs::pack(form); }

    /// How far behind their places in Kifs the fractal's parameters lie.
    static constexpr size_t behind = size_t{fractal} - size_t{Kifs::centreOfScale};
    static constexpr uint32_t foldSteps(uint32_t data) { return Kifs::foldSteps(data); }
    /// Near the ornament some cells are folded, far from it none.
    static constexpr uint32_t cost(uint32_t operands, uint32_t data) { return 200 + 2 * Kifs::cost(operands, data); }

    static constexpr GlslNumber glslNumbers[] = {{"atPosition", position},
                                                 {"atOuter", outer},
                                                 {"atInner", inner},
                                                 {"atCentre", fractal},
                                                 {"atScale", behind + size_t{Kifs::scale}},
                                                 {"atFold", behind + size_t{Kifs::fold}},
                                                 {"atTurn", behind + size_t{Kifs::turn}},
                                                 {"atPeriod", period},
                                                 {"atShrink", shrink},
                                                 {"atMirrors", mirrors},
                                                 {"atStorey", storey},
                                                 {"atStoreys", storeys},
                                                 {"atRise", rise},
                                                 {"atMost", most},
                                                 {"atDeepest", deepest},
                                                 {"atSlack", slack},
                                                 {"atBays", bays},
                                                 {"mostBays", mostBays},
                                                 {"passesMask", Kifs::passesMask},
                                                 {"isCube", Kifs::isCube},
                                                 {"hasFold", Kifs::hasFold},
                                                 {"hasTurn", Kifs::hasTurn}};
    /// The operands from the fractal on have to be constants here, as modeler/field/facade.cpp makes them: fetching
    /// them from registers too took a third of a picture's time.
    static constexpr std::string_view glsl = R"(
#define number(at) uintBitsToFloat(texelFetch(tapeWords, int(at)).x)
float most = number(first + atMost);
if (arg(first + atOuter) >= most || arg(first + atInner) <= -number(first + atDeepest)) return most;
vec3 c = vec3(number(first + atCentre), number(first + atCentre + 1u), number(first + atCentre + 2u));
float s = number(first + atScale), h = c.z * (s - 1.0) * 0.5;
mat3 r2 = mat3(1.0), r1 = mat3(1.0);
for (uint i = 0u; i < 9u; ++i) {
    if ((data & hasFold) != 0u) r2[i / 3u][i % 3u] = number(first + atFold + i);
    if ((data & hasTurn) != 0u) r1[i / 3u][i % 3u] = number(first + atTurn + i);
}
vec2 period = vec2(number(first + atPeriod), number(first + atPeriod + 1u));
vec2 reach = period * vec2(number(first + atShrink), number(first + atShrink + 1u)) * 0.5;
vec2 raw = abs(fract(vec2(arg(first + atPosition), arg(first + atPosition + 2u)) / period) * 2.0 - 1.0), u = raw;
for (uint i = 0u; i < 3u; ++i) u = abs(abs(u - number(first + atMirrors + i)) - number(first + atMirrors + i));
float height = number(first + atStorey), last = number(first + atStoreys) - 1.0, rise = number(first + atRise), slack = number(first + atSlack);
float up = arg(first + atPosition + 1u) / height, level = min(max(floor(up), 0.0), last), v = up - level;
float below = level > 0.0 ? v : 1e4, above = level < last ? 1.0 - v : 1e4;
float edge = min(below, above) * height, beyond = below < above ? v + 1.0 : v - 1.0;
uint bays = 1u;
uvec2 own = uvec2(0u);
for (; bays < mostBays; ++bays) {
    float from = number(first + atBays + 3u * bays);
    if (from >= 2.0) break;
    own = uvec2(raw.x >= from ? bays : own.x, raw.y >= from ? bays : own.y);
}
// The own cell first, then those whose slab is nearer than the best so far: over the rows of bays, storeys of each in turn.
float best = most;
bool here = true, over = false;
uvec2 bay = own;
vec2 off = vec2(0.0);
for (int axis = 0; axis < 2; ++axis) {
    uint at = first + atBays + 3u * own[axis];
    off[axis] = max((own[axis] == 0u ? -1e4 : number(at)) - raw[axis], raw[axis] - (own[axis] + 1u == bays ? 1e4 : number(at + 3u))) * reach[axis];
}
float border = min(min(-off.x, -off.y), edge) - slack, slab = max(max(off.x, off.y), -edge) - slack;
for (uint next = 0u;;) {
    uvec2 at = first + atBays + 3u * bay;
    vec2 zoom = vec2(number(at.x + 1u), number(at.y + 1u));
    vec2 across = zoom * u + vec2(number(at.x + 2u), number(at.y + 2u));
    vec3 p = vec3(across.x, rise * (over ? beyond : v), across.y);
    float scales = 1.0;
    for (uint pass = 0u; pass < (data & passesMask); ++pass) {
        p = abs(r1 * p);
        p.xy = vec2(max(p.x, p.y), min(p.x, p.y));
        p.xz = vec2(max(p.x, p.z), min(p.x, p.z));
        p.yz = vec2(max(p.y, p.z), min(p.y, p.z));
        p = r2 * p * s;
        p.xy -= c.xy * (s - 1.0);
        p.z = h - abs(p.z - h);
        scales *= s;
    }
    vec3 q = abs(p);
    float d = (data & isCube) != 0u ? max(max(q.x, q.y), q.z) - max(max(c.x, c.y), c.z) : length(p) - 2.0;
    vec2 k = abs(zoom) / reach;
    best = min(best, max(d / (scales * max(max(k.x, k.y), rise / height)), slab));
    if (here && best <= border) return best;  // nothing else is so near
    here = false;
    bool found = false;
    while (!found && next < 2u * bays * bays) {
        uint column = next % (2u * bays);
        bay = uvec2(column / 2u, next / (2u * bays));
        over = (next & 1u) == 0u;
        at = first + atBays + 3u * bay;
        if (column == 0u) off.y = max((bay.y == 0u ? -1e4 : number(at.y)) - raw.y, raw.y - (bay.y + 1u == bays ? 1e4 : number(at.y + 3u))) * reach.y;
        if (off.y - slack >= best) {
            next += 2u * bays - column;
            continue;
        }
        if (over) off.x = max((bay.x == 0u ? -1e4 : number(at.x)) - raw.x, raw.x - (bay.x + 1u == bays ? 1e4 : number(at.x + 3u))) * reach.x;
        slab = max(max(off.x, off.y), over ? edge : -edge) - slack;
        found = slab < best && (over || bay != own);
        ++next;
    }
    if (!found) return best;
}
return best;)";

    using Path = Kifs::Path;
    template <class V, class W>
    using NumberOf = Kifs::NumberOf<V, W>;
    static constexpr void visitPath(const Kifs::Form& form, auto&& visit) { Kifs::visitPath(form, visit); }

    /// What a point is asked about, made from the parameters: once for all points, where those are numbers.
    template <class V>
    struct UniformParams {
        Kifs::Form form;
        Kifs::Folds<V> folds;
        struct Axis {
            V perPeriod;
            V reach;  ///< metres of the world of half a period, at least
        } axis[2];
        V mirror[3], storey, perStorey, lastStorey, rise, perRise, most, deepest, slack;
        /// From `from` on in half a period, to where the next one begins: its scale and shift, and along either axis
        /// the least metres of the world that its map makes one of.
        struct Bay {
            V from, zoom, pan, shrink[2];
        } bay[mostBays + 1];
        uint32_t bays = 1;

        /// Of `args` the parameters are read, at their places.
        [[gnu::always_inline]] UniformParams(std::span<const V> args, uint32_t data)
            : form(Kifs::unpack(data)),
              folds(args.subspan(fractal - size_t{Kifs::centreOfScale}), data),
              storey(args[Facade::storey]),
              perStorey(V(1.0f) / storey),
              lastStorey(args[storeys] - V(1.0f)),
              rise(args[Facade::rise]),
              perRise(storey / rise),
              most(args[Facade::most]),
              deepest(args[Facade::deepest]),
              slack(args[Facade::slack]) {
            for (size_t i = 0; i < 2; ++i) {
                const V& length = args[period + i];
                axis[i] = {V(1.0f) / length, length * args[Facade::shrink + i] * V(0.5f)};
            }
            for (size_t i = 0; i < 3; ++i) mirror[i] = args[mirrors + i];
            while (bays < mostBays && any(args[Facade::bays + 3 * bays] < V(2.0f))) ++bays;
            for (uint32_t i = 0; i < bays; ++i) {
                const V* const b = &args[Facade::bays + 3 * i];
                const V size = abs(b[1]);
                bay[i] = {i == 0 ? V(-nowhere) : b[0], b[1], b[2], {axis[0].reach / size, axis[1].reach / size}};
            }
            bay[bays].from = V(nowhere);
        }
    };

    template <class V>
    static V apply(std::span<const V> args, uint32_t data) {
        const UniformParams<V> numbers(args, data);
        V value;
        visitPath(numbers.form, [&]<Path path>() { value = evalUniform<path>(args.data(), numbers); });
        return value;
    }

    /// The value at (x, y, z) between the shells; numbers as in Kifs.
    template <Path path, class V, class W>
    [[gnu::always_inline]] static V evalUniform(const V* at, const UniformParams<W>& n) {
        const V limit = V(n.most);
        const auto decided = (at[outer] >= limit) | (at[inner] <= V(-n.deepest));
        const auto open = !decided;
        if (!any(open)) return limit;
        const NumberOf<V, W> slack = n.slack;
        const Along<V, W> x = along(at[position], n, 0), z = along(at[position + 2], n, 1);
        const Up<V> up = levels(at[position + 1], n);
        const V own = cell<path>(n, x, x.own, z, z.own, up.v);
        V best = min(max(own, max(max(x.off, z.off), -up.edge) - slack), limit);
        const V border = min(min(-x.off, -z.off), up.edge) - slack;
        if (!any((best > border) & open)) return select(decided, limit, best);  // no other cell is so near
        for (uint32_t j = 0; j < n.bays; ++j) {
            const V offZ = z.to(j, n);
            if (!any((offZ - slack < best) & open)) continue;
            for (uint32_t i = 0; i < n.bays; ++i) {
                const V off = max(x.to(i, n), offZ);
                if (!any((off - slack < best) & open)) continue;
                const auto inOwn = x.within(i, n) & z.within(j, n);
                for (const bool over : {false, true}) {
                    const V slab = max(off, over ? up.edge : -up.edge) - slack;
                    auto counts = (slab < best) & open;
                    if (!over) counts = counts & !inOwn;
                    if (!any(counts)) continue;
                    const V d = cell<path>(n, x, x.bay(i, n), z, z.bay(j, n), over ? up.beyond : up.v);
                    best = min(max(d, slab), best);  // nothing new for lanes that don't count
                }
            }
        }
        return select(decided, limit, best);
    }

    /// f(centre) ± the radius of the box, where the numbers are fixed.
    template <class I>
    static I interval(std::span<const I> args, uint32_t data) {
        using V = typename I::Value;
        constexpr float infinity = std::numeric_limits<float>::infinity();
        V middle[operandCount], spread = 0.0f;
        for (size_t i = 0; i < operandCount; ++i) middle[i] = i < outer ? centre(args[i]) : args[i].lo;
        for (size_t i = varyingOperands; i < operandCount; ++i) spread = max(args[i].hi - args[i].lo, spread);
        if (any(!(spread <= V(0.0f)))) return I{V(-infinity), V(infinity)};
        const V limit = middle[most], deep = middle[deepest];
        const auto decided = (args[outer].lo >= limit) | (args[inner].hi <= -deep);
        const auto may = (args[outer].hi >= limit) | (args[inner].lo <= -deep);
        if (!any(!decided)) return I{limit, limit};
        middle[outer] = V(0.0f), middle[inner] = V(0.0f);  // where no shell decides
        const V value = apply<V>(std::span<const V>(middle, operandCount), data);
        const V rx = radius(args[0]) * middle[shrink], ry = radius(args[1]), rz = radius(args[2]) * middle[shrink + 1];
        const V size = abs(middle[0]) * middle[shrink] + abs(middle[1]) + abs(middle[2]) * middle[shrink + 1];
        const V reach = sqrt(rx * rx + ry * ry + rz * rz) * 1.00001f + size * 2e-6f + middle[rounding];
        const V lo = max(-deep, value - reach), hi = min(limit, value + reach);
        // Nothing is known so far out that a fold might overflow.
        const auto near = size + reach <= V(1e9f);
        return I{select(decided, limit, lo), select(may, limit, hi)}.where(decided | near);
    }

private:
    static constexpr float nowhere = 1e4f;

    /// A bay as one axis sees it.
    template <class W>
    struct Seen {
        W zoom, pan, shrink;
    };
    /// One horizontal axis: where in half a period, folded, and in which bay.
    template <class V, class W, class N = NumberOf<V, W>>
    struct Along {
        uint32_t axis;
        V raw, u;  ///< 0 … 1: before and after the paper's folds
        V off;     ///< signed distance to the own bay, metres
        Seen<N> own;

        Seen<N> bay(uint32_t i, const UniformParams<W>& n) const {
            return {n.bay[i].zoom, n.bay[i].pan, n.bay[i].shrink[axis]};
        }
        /// Signed distance to a bay, metres.
        V to(uint32_t i, const UniformParams<W>& n) const { return between(n.bay[i].from, n.bay[i + 1].from, n); }
        V between(const N& from, const N& end, const UniformParams<W>& n) const {
            return max(from - raw, raw - end) * N(n.axis[axis].reach);
        }
        auto within(uint32_t i, const UniformParams<W>& n) const {
            return (raw >= V(n.bay[i].from)) & (raw < V(n.bay[i + 1].from));
        }
    };
    /// The storeys around a height.
    template <class V>
    struct Up {
        V v;       ///< height in the own storey, 0 … 1; below the first one and above the last one it goes on
        V beyond;  ///< the same in the nearer neighbour
        V edge;    ///< metres to the neighbour
    };

    template <class V, class W>
    [[gnu::always_inline]] static Along<V, W> along(const V& at, const UniformParams<W>& n, uint32_t axis) {
        Along<V, W> a;  // to be written once: clearing it first took an eighth of a facade's time
        a.axis = axis;
        using N = NumberOf<V, W>;
        const V turn = at * N(n.axis[axis].perPeriod);
        a.raw = abs((turn - floor(turn)) * N(2.0f) - N(1.0f));
        a.u = a.raw;
        for (const W& r : n.mirror) a.u = abs(abs(a.u - N(r)) - N(r));
        N from = n.bay[0].from, end = n.bay[1].from, zoom = n.bay[0].zoom, pan = n.bay[0].pan,
          shrink = n.bay[0].shrink[axis];
        for (uint32_t i = 1; i < n.bays; ++i) {
            const auto here = a.raw >= V(n.bay[i].from);
            if (!any(here)) break;
            from = select(here, n.bay[i].from, from);
            end = select(here, n.bay[i + 1].from, end);
            zoom = select(here, n.bay[i].zoom, zoom);
            pan = select(here, n.bay[i].pan, pan);
            shrink = select(here, n.bay[i].shrink[axis], shrink);
        }
        a.own = {zoom, pan, shrink};
        a.off = a.between(from, end, n);
        return a;
    }

    template <class V, class W>
    [[gnu::always_inline]] static Up<V> levels(const V& y, const UniformParams<W>& n) {
        using N = NumberOf<V, W>;
        const V up = y * N(n.perStorey), last = V(n.lastStorey);
        const V level = min(max(floor(up), V(0.0f)), last), v = up - level;
        const V below = select(level > V(0.0f), v, V(nowhere)), above = select(level < last, N(1.0f) - v, V(nowhere));
        return {v, select(below < above, v + N(1.0f), v - N(1.0f)), min(below, above) * N(n.storey)};
    }

    /// Distance to one cell's fractal, its map continued beyond the cell; divided by the map's greatest stretch.
    template <Path path, class V, class W, class N = NumberOf<V, W>>
    [[gnu::always_inline]] static V cell(const UniformParams<W>& n, const Along<V, W>& x, const Seen<N>& inX,
                                         const Along<V, W>& z, const Seen<N>& inZ, const V& v) {
        const V at[] = {x.u * inX.zoom + inX.pan, v * N(n.rise), z.u * inZ.zoom + inZ.pan};
        return Kifs::folded<path>(at, n.folds) * min(min(inX.shrink, inZ.shrink), N(n.perRise));
    }
};

}  // namespace sgm::field::ops
