// A facade of KIFS cells as an op: McGraw, eq. 4 and algorithm 2, with the errata of docs/papers.md.
// Enters: a position in metres from the origin of the tiling (x along the walls, y up, z across), the distances to the
// outer and the inner shell, and numbers from modeler/field/facade.cpp. Leaves: a bound of the distance to the infinite
// facade, at most `most`; exactly `most` where a shell decides anyway (outer ≥ most or inner ≤ −deepest), so that the
// fractal costs nothing there. Assumes the continuous form of the fractal.
// Space is cut into cells: storeys in y, and in x and z the bays of one facade id, which the paper's folds make of half a
// period. Inside a cell the map is continuous; from cell to cell it jumps. The field is the least over all cells of
// max(distance to the cell's fractal, distance to the cell's slab): the same solid, but 1-Lipschitz. A slab reaches `slack`
// over its border, so that no surface stays between two cells that are full there.
#pragma once

#include <limits>
#include <span>
#include <string_view>

#include "modeler/field/kifs.h"

namespace sgm::field::ops {

struct Facade {
    static constexpr std::string_view name = "facade";
    static constexpr int arity = variadic;
    static constexpr size_t moving = 5;
    /// Three folds cut half a period into no more pieces.
    static constexpr size_t mostBays = 14;

    static constexpr size_t fractalCount = size_t{Kifs::bailout} - size_t{Kifs::centreOfScale};
    /// Places of the operands; the fractal's parameters lie as in Kifs, from its centre to its turn.
    enum Operand : size_t {
        position,
        outer = 3,  ///< distance to the outer shell
        inner,      ///< distance to the inner shell
        fractal,  ///< from the centre of scaling to the turn
        period = fractal + fractalCount,  ///< along x and along z, metres
        shrink = period + 2,                                     ///< least world length of a metre of x, of z
        mirrors = shrink + 2,                                    ///< r₁ r₂ r₃
        storey = mirrors + 3,                                    ///< height, metres
        storeys,                                                 ///< how many
        rise,                                                    ///< s_y
        most,
        deepest,
        slack,
        rounding,
        bays,  ///< of each: where it begins in half a period (0 … 1; `noBay` for none), scale and shift
        operandCount = bays + 3 * mostBays
    };

    static constexpr float noBay = 3;
    static constexpr uint32_t pack(const Kifs::Form& form) { return Kifs::pack(form); }

    /// The operands from the fractal on have to be constants here, as modeler/field/facade.cpp makes them: fetching them from
    /// registers too took a third of a picture's time.
    static constexpr std::string_view glsl = R"(
#define number(at) uintBitsToFloat(texelFetch(tapeWords, int(at)).x)
float most = number(first + 37u);
if (arg(first + 3u) >= most || arg(first + 4u) <= -number(first + 38u)) return most;
vec3 c = vec3(number(first + 5u), number(first + 6u), number(first + 7u));
float s = number(first + 8u), h = c.z * (s - 1.0) * 0.5;
mat3 r2 = mat3(1.0), r1 = mat3(1.0);
for (uint i = 0u; i < 9u; ++i) {
    if ((data & 2048u) != 0u) r2[i / 3u][i % 3u] = number(first + 9u + i);
    if ((data & 4096u) != 0u) r1[i / 3u][i % 3u] = number(first + 18u + i);
}
vec2 period = vec2(number(first + 27u), number(first + 28u));
vec2 reach = period * vec2(number(first + 29u), number(first + 30u)) * 0.5;
vec2 raw = abs(fract(vec2(arg(first), arg(first + 2u)) / period) * 2.0 - 1.0), u = raw;
for (uint i = 0u; i < 3u; ++i) u = abs(abs(u - number(first + 31u + i)) - number(first + 31u + i));
float height = number(first + 34u), last = number(first + 35u) - 1.0, rise = number(first + 36u), slack = number(first + 39u);
float up = arg(first + 1u) / height, level = min(max(floor(up), 0.0), last), v = up - level;
float below = level > 0.0 ? v : 1e4, above = level < last ? 1.0 - v : 1e4;
float edge = min(below, above) * height, beyond = below < above ? v + 1.0 : v - 1.0;
uint bays = 1u;
uvec2 own = uvec2(0u);
for (; bays < 14u; ++bays) {
    float from = number(first + 41u + 3u * bays);
    if (from >= 2.0) break;
    own = uvec2(raw.x >= from ? bays : own.x, raw.y >= from ? bays : own.y);
}
// The own cell first, then those whose slab is nearer than the best so far: over the rows of bays, storeys of each in turn.
float best = most;
bool here = true, over = false;
uvec2 bay = own;
vec2 off = vec2(0.0);
for (int axis = 0; axis < 2; ++axis) {
    uint at = first + 41u + 3u * own[axis];
    off[axis] = max((own[axis] == 0u ? -1e4 : number(at)) - raw[axis], raw[axis] - (own[axis] + 1u == bays ? 1e4 : number(at + 3u))) * reach[axis];
}
float border = min(min(-off.x, -off.y), edge) - slack, slab = max(max(off.x, off.y), -edge) - slack;
for (uint next = 0u;;) {
    uvec2 at = first + 41u + 3u * bay;
    vec2 zoom = vec2(number(at.x + 1u), number(at.y + 1u));
    vec2 across = zoom * u + vec2(number(at.x + 2u), number(at.y + 2u));
    vec3 p = vec3(across.x, rise * (over ? beyond : v), across.y);
    float scales = 1.0;
    for (uint pass = 0u; pass < (data & 255u); ++pass) {
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
    float d = (data & 256u) != 0u ? max(max(q.x, q.y), q.z) - max(max(c.x, c.y), c.z) : length(p) - 2.0;
    vec2 k = abs(zoom) / reach;
    best = min(best, max(d / (scales * max(max(k.x, k.y), rise / height)), slab));
    if (here && best <= border) return best;  // nothing else is so near
    here = false;
    bool found = false;
    while (!found && next < 2u * bays * bays) {
        uint column = next % (2u * bays);
        bay = uvec2(column / 2u, next / (2u * bays));
        over = (next & 1u) == 0u;
        at = first + 41u + 3u * bay;
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

    template <class V>
    static V apply(std::span<const V> args, uint32_t data) {
        const V limit = args[most];
        const auto decided = (args[outer] >= limit) | (args[inner] <= -args[deepest]);
        const auto open = !decided;
        if (!any(open)) return limit;
        const uint32_t count = countOf(args);
        const Along<V> x = along(args, 0, count), z = along(args, 1, count);
        const Up<V> up = levels(args);
        const Kifs::Numbers<V> folds(args.subspan(fractal - size_t{Kifs::centreOfScale}), data);
        const V own = cell(args, folds, x, x.zoom, x.pan, z, z.zoom, z.pan, up.v);
        V best = min(max(own, max(max(x.least, z.least), -up.edge) - args[slack]), limit);
        const V border = min(min(-x.least, -z.least), up.edge) - args[slack];
        if (!any((best > border) & open)) return select(decided, limit, best);  // no other cell is so near
        for (uint32_t j = 0; j < count; ++j) {
            if (!any((z.off[j] - args[slack] < best) & open)) continue;
            for (uint32_t i = 0; i < count; ++i) {
                const V off = max(x.off[i], z.off[j]);
                if (!any((off - args[slack] < best) & open)) continue;
                const auto inOwn = x.within(args, i, count) & z.within(args, j, count);
                for (const bool over : {false, true}) {
                    const V slab = max(off, over ? up.edge : -up.edge) - args[slack];
                    auto counts = (slab < best) & open;
                    if (!over) counts = counts & !inOwn;
                    if (!any(counts)) continue;
                    const V *a = &args[bays + 3 * i], *b = &args[bays + 3 * j];
                    const V d = cell(args, folds, x, a[1], a[2], z, b[1], b[2], over ? up.beyond : up.v);
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
        for (size_t i = moving; i < operandCount; ++i) spread = max(args[i].hi - args[i].lo, spread);
        if (any(!(spread <= V(0.0f)))) return I{V(-infinity), V(infinity)};
        const V limit = middle[most], deep = middle[deepest];
        const auto decided = (args[outer].lo >= limit) | (args[inner].hi <= -deep);
        const auto may = (args[outer].hi >= limit) | (args[inner].lo <= -deep);
        if (!any(!decided)) return I{limit, limit};
        middle[outer] = V(0.0f), middle[inner] = V(0.0f);  // where no shell decides
        const V value = apply<V>(middle, data);
        const V rx = radius(args[0]) * middle[shrink], ry = radius(args[1]), rz = radius(args[2]) * middle[shrink + 1];
        const V size = abs(middle[0]) * middle[shrink] + abs(middle[1]) + abs(middle[2]) * middle[shrink + 1];
        const V reach = sqrt(rx * rx + ry * ry + rz * rz) * 1.00001f + size * 2e-6f + middle[rounding];
        const V lo = max(-deep, value - reach), hi = min(limit, value + reach);
        return I{select(decided, limit, lo), select(may, limit, hi)};
    }

private:
    /// One horizontal axis: where in half a period, folded, and in which bay.
    template <class V>
    struct Along {
        V raw, u;         ///< 0 … 1: before and after the paper's folds
        V reach;          ///< metres of the world of half a period, at least
        V zoom, pan;      ///< of the own bay
        V off[mostBays];  ///< signed distance to every bay, metres
        V least;          ///< to the own one

        auto within(std::span<const V> args, uint32_t bay, uint32_t count) const {
            const auto from = raw >= (bay == 0 ? V(-1.0f) : args[bays + 3 * bay]);
            return bay + 1 == count ? from : from & (raw < args[bays + 3 * bay + 3]);
        }
    };
    /// The storeys around a height.
    template <class V>
    struct Up {
        V v;       ///< height in the own storey, 0 … 1; below the first one and above the last one it goes on
        V beyond;  ///< the same in the nearer neighbour
        V edge;    ///< metres to the neighbour
    };
    static constexpr float nowhere = 1e4f;

    template <class V>
    static uint32_t countOf(std::span<const V> args) {
        uint32_t count = 1;
        while (count < mostBays && any(args[bays + 3 * count] < V(2.0f))) ++count;
        return count;
    }

    template <class V>
    static Along<V> along(std::span<const V> args, size_t axis, uint32_t count) {
        Along<V> a;
        const V& w = args[period + axis];
        const V turn = args[position + 2 * axis] / w;
        a.raw = abs((turn - floor(turn)) * V(2.0f) - V(1.0f));
        a.reach = w * args[shrink + axis] * V(0.5f);
        a.u = a.raw;
        for (size_t i = 0; i < 3; ++i) a.u = abs(abs(a.u - args[mirrors + i]) - args[mirrors + i]);
        a.zoom = args[bays + 1], a.pan = args[bays + 2];
        for (uint32_t i = 0; i < count; ++i) {
            const V* bay = &args[bays + 3 * i];
            const V from = i == 0 ? V(-nowhere) : bay[0] - a.raw;
            const V to = i + 1 == count ? V(-nowhere) : a.raw - bay[3];
            a.off[i] = max(from, to) * a.reach;
            a.least = i == 0 ? a.off[0] : min(a.off[i], a.least);
            if (i == 0) continue;
            const auto here = a.raw >= bay[0];
            a.zoom = select(here, bay[1], a.zoom);
            a.pan = select(here, bay[2], a.pan);
        }
        return a;
    }

    template <class V>
    static Up<V> levels(std::span<const V> args) {
        const V up = args[position + 1] / args[storey], last = args[storeys] - V(1.0f);
        const V level = min(max(floor(up), V(0.0f)), last), v = up - level;
        const V below = select(level > V(0.0f), v, V(nowhere)), above = select(level < last, V(1.0f) - v, V(nowhere));
        return {v, select(below < above, v + V(1.0f), v - V(1.0f)), min(below, above) * args[storey]};
    }

    /// Distance to one cell's fractal, its map continued beyond the cell; divided by the map's greatest stretch.
    template <class V>
    static V cell(std::span<const V> args, const Kifs::Numbers<V>& folds, const Along<V>& x, const V& zoomX,
                  const V& panX, const Along<V>& z, const V& zoomZ, const V& panZ, const V& v) {
        const V stretch = max(max(abs(zoomX) / x.reach, abs(zoomZ) / z.reach), args[rise] / args[storey]);
        return Kifs::distance(zoomX * x.u + panX, args[rise] * v, zoomZ * z.u + panZ, folds) / stretch;
    }
};

}  // namespace sgm::field::ops
