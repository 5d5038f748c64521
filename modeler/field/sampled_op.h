// A sampled grid as an op: its samples, interpolated along the three axes; beyond the grid a lower bound of the
// distance. Enters: operands x, y, z in the grid's own frame, and the words of a SampledGrid. Leaves: the distance.
// Assumes that the samples on the grid's border are positive. Beyond the grid: with q the nearest place of its box,
// √(f(q)² + |p − q|²). The two gradients are square to each other, so it is as steep as f at most, and no more than the
// true distance, since the box is convex.
#pragma once

#include <limits>
#include <span>
#include <string_view>

#include "modeler/field/sampled_grid.h"
#include "modeler/field/values.h"

namespace sgm::field::ops {

struct Sampled {
    static constexpr std::string_view name = "sampled";
    static constexpr int arity = variadic;
    static constexpr size_t operandCount = 3, varyingOperands = 3;
    static constexpr bool readsGrid = true;
    static constexpr uint32_t cost = 320;  // eight gathers

    static constexpr GlslNumber glslNumbers[] = {{"atPosition", 0},
                                                 {"atLow", SampledGrid::low},
                                                 {"atCell", SampledGrid::cell},
                                                 {"atInverseCell", SampledGrid::inverseCell},
                                                 {"atCells", SampledGrid::cells},
                                                 {"atNodesX", SampledGrid::nodesX},
                                                 {"atNodesXY", SampledGrid::nodesXY},
                                                 {"firstSample", SampledGrid::firstSample}};
    static constexpr std::string_view glsl =
        "vec3 low = vec3(word(data, atLow), word(data, atLow + 1u), word(data, atLow + 2u));\n"
        "vec3 cells = vec3(word(data, atCells), word(data, atCells + 1u), word(data, atCells + 2u));\n"
        "vec3 u = (arg3(first + atPosition) - low) * word(data, atInverseCell);\n"
        "vec3 q = clamp(u, vec3(0.0), cells), c = min(floor(q), cells - 1.0), t = q - c;\n"
        "vec3 off = (u - q) * word(data, atCell);\n"
        "uint sy = uint(word(data, atNodesX)), sz = uint(word(data, atNodesXY));\n"
        "uint at = firstSample + uint(c.x) + uint(c.y) * sy + uint(c.z) * sz;\n"
        "vec4 y = vec4(word(data, at), word(data, at + sy), word(data, at + sz), word(data, at + sy + sz));\n"
        "++at;\n"
        "y += t.x * (vec4(word(data, at), word(data, at + sy), word(data, at + sz), word(data, at + sy + sz)) - y);\n"
        "float near = y.x + t.y * (y.y - y.x), far = y.z + t.y * (y.w - y.z), f = near + t.z * (far - near);\n"
        "float beyond = dot(off, off);\n"
        "return beyond > 0.0 ? sqrt(f * f + beyond) : f;";

    template <class V>
    static V apply(std::span<const V> args, const float* grid) {
        const Place<V> x = place(args[0], grid, 0), y = place(args[1], grid, 1), z = place(args[2], grid, 2);
        return beyond(patch(x, y, z, grid).value, x, y, z);
    }

    /// Opaque: value at the centre ± L·r, not below the least sample.
    template <class I>
    static I interval(std::span<const I> args, const float* grid) {
        using V = typename I::Value;
        const V centres[] = {centre(args[0]), centre(args[1]), centre(args[2])};
        const V rx = radius(args[0]), ry = radius(args[1]), rz = radius(args[2]);
        const float bound = grid[SampledGrid::lipschitzBound], least = grid[SampledGrid::least];
        const float corner =
            abs(grid[SampledGrid::low]) + abs(grid[SampledGrid::low + 1]) + abs(grid[SampledGrid::low + 2]);
        // Rounding: of the place in the grid, as steep as the field, and of the sums.
        const V value = apply<V>(centres, grid);
        const V ulps = (abs(centres[0]) + abs(centres[1]) + abs(centres[2]) + V(corner)) * 4e-7f + abs(value) * 2e-6f +
                       V(abs(least) * 2e-6f);
        const V reach = (sqrt(rx * rx + ry * ry + rz * rz) * 1.000001f + ulps) * bound;
        return around<I>(value, reach, least * 1.00001f, std::numeric_limits<float>::infinity());
    }

    template <class D>
    static D gradient(std::span<const D> args, const float* grid) {
        using V = typename D::Value;
        const Place<V> x = place(args[0].value, grid, 0), y = place(args[1].value, grid, 1),
                       z = place(args[2].value, grid, 2);
        const Patch<V> f = patch(x, y, z, grid);
        const V value = beyond(f.value, x, y, z);
        const auto inside = !(square(x, y, z) > V(0.0f));
        const V share = V(1.0f) / select(inside, V(1.0f), value);
        const auto slope = [&](const Place<V>& at, const V& df) {
            const V within = df * grid[SampledGrid::inverseCell];
            return select(inside, within, select(abs(at.off) > V(0.0f), at.off, within * f.value) * share);
        };
        const V dx = slope(x, f.dx), dy = slope(y, f.dy), dz = slope(z, f.dz);
        const auto along = [&](const V& a, const V& b, const V& c) { return dx * a + dy * b + dz * c; };
        return D{value, along(args[0].dx, args[1].dx, args[2].dx), along(args[0].dy, args[1].dy, args[2].dy),
                 along(args[0].dz, args[1].dz, args[2].dz)};
    }

private:
    /// Where a coordinate lies: its cell, its share of the cell, and how far beyond the grid it is, metres.
    template <class V>
    struct Place {
        V cell, share, off;
    };
    /// A value and its derivatives by shares of a cell.
    template <class V>
    struct Patch {
        V value, dx, dy, dz;
    };

    template <class V>
    static Place<V> place(const V& p, const float* grid, size_t axis) {
        const float cells = grid[SampledGrid::cells + axis];
        const V u = (p - V(grid[SampledGrid::low + axis])) * V(grid[SampledGrid::inverseCell]);
        const V within = max(min(u, V(cells)), V(0.0f));  // a NaN becomes a number: what it reads is there
        const V cell = min(floor(within), V(cells - 1));
        return {cell, within - cell, (u - within) * V(grid[SampledGrid::cell])};
    }

    template <class V>
    static V square(const Place<V>& x, const Place<V>& y, const Place<V>& z) {
        return x.off * x.off + y.off * y.off + z.off * z.off;
    }
    /// NaN where a coordinate is.
    template <class V>
    static V beyond(const V& f, const Place<V>& x, const Place<V>& y, const Place<V>& z) {
        const V d = square(x, y, z);
        return select(d <= V(0.0f), f, sqrt(f * f + d));
    }

    template <class V>
    static Patch<V> patch(const Place<V>& x, const Place<V>& y, const Place<V>& z, const float* grid) {
        using Int = IntOf<V>;
        const auto rowStep = static_cast<uint32_t>(grid[SampledGrid::nodesX]),
                   layerStep = static_cast<uint32_t>(grid[SampledGrid::nodesXY]);
        const Int at = toInt(x.cell) + toInt(y.cell) * Int(rowStep) + toInt(z.cell) * Int(layerStep);
        const auto from = [&](uint32_t step) { return grid + SampledGrid::firstSample + step; };
        const auto low = [&](uint32_t step) { return gather(from(step), at); };
        const V v00 = low(0), v10 = low(rowStep), v01 = low(layerStep), v11 = low(layerStep + rowStep);
        const V d00 = low(1) - v00, d10 = low(rowStep + 1) - v10, d01 = low(layerStep + 1) - v01,
                d11 = low(layerStep + rowStep + 1) - v11;
        const V e00 = v00 + x.share * d00, e10 = v10 + x.share * d10, e01 = v01 + x.share * d01,
                e11 = v11 + x.share * d11;
        const V near = e00 + y.share * (e10 - e00), far = e01 + y.share * (e11 - e01);
        const V dxNear = d00 + y.share * (d10 - d00), dxFar = d01 + y.share * (d11 - d01);
        const V dyNear = e10 - e00, dyFar = e11 - e01;
        return {near + z.share * (far - near), dxNear + z.share * (dxFar - dxNear), dyNear + z.share * (dyFar - dyNear),
                far - near};
    }
};

}  // namespace sgm::field::ops
