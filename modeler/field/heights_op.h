// Heights over the plan as an op: those of a lattice, bilinear between its corners; beyond it those of its border.
// Enters: operands x and z in the lattice's own frame, and the words of heightGrid. Leaves: the height. Assumes finite
// heights. Over a box it is enclosed by the heights of at most four squares of the lattice's pyramid that hold the box,
// and by the steepest slope.
#pragma once

#include <span>
#include <string_view>

#include "modeler/field/height_grid.h"
#include "modeler/field/values.h"

namespace sgm::field::ops {

struct Heights {
    static constexpr std::string_view name = "heights";
    static constexpr int arity = variadic;
    static constexpr size_t operandCount = 2, varyingOperands = 2;
    static constexpr bool readsGrid = true;

    static constexpr uint32_t cost = 180;  // four gathers

    static constexpr GlslNumber glslNumbers[] = {{"atPosition", 0},
                                                 {"atLow", SampledGrid::low},
                                                 {"atInverseCell", SampledGrid::inverseCell},
                                                 {"atCells", SampledGrid::cells},
                                                 {"atNodesX", SampledGrid::nodesX},
                                                 {"firstHeight", HeightWords::firstHeight}};
    static constexpr std::string_view glsl =
        "vec2 cells = vec2(word(data, atCells), word(data, atCells + 1u));\n"
        "vec2 low2 = vec2(word(data, atLow), word(data, atLow + 1u));\n"
        "vec2 p = vec2(arg(first + atPosition), arg(first + atPosition + 1u));\n"
        "vec2 q = clamp((p - low2) * word(data, atInverseCell), vec2(0.0), cells);\n"
        "vec2 c = min(floor(q), cells - 1.0), t = q - c;\n"
        "uint row = uint(word(data, atNodesX)), at = firstHeight + uint(c.x) + uint(c.y) * row;\n"
        "float low = word(data, at), high = word(data, at + row);\n"
        "low += t.x * (word(data, at + 1u) - low);\n"
        "high += t.x * (word(data, at + row + 1u) - high);\n"
        "return low + t.y * (high - low);";

    template <class V>
    static V apply(std::span<const V> args, const float* grid) {
        return patch(place(args[0], grid, 0), place(args[1], grid, 1), grid).height;
    }

    template <class I>
    static I interval(std::span<const I> args, const float* grid) {
        using V = typename I::Value;
        const Span<V> x = cellsOf<V>(args[0].lo, args[0].hi, grid, 0), z = cellsOf<V>(args[1].lo, args[1].hi, grid, 1);
        const Bounds<V> squares = ofSquares(x, z, grid);
        // Between two heights, sums of rounded products go no farther out than a few units of their last place.
        const V slack = max(abs(squares.least), abs(squares.most)) * 1e-6f;
        const auto at = [&](const V& px, const V& pz) {
            return patch(place(px, grid, 0), place(pz, grid, 1), grid).height;
        };
        // A bilinear patch is least and greatest at corners of the box.
        const V h00 = at(args[0].lo, args[1].lo), h10 = at(args[0].hi, args[1].lo), h01 = at(args[0].lo, args[1].hi),
                h11 = at(args[0].hi, args[1].hi);
        const auto oneCell = (x.first >= x.last) & (z.first >= z.last);
        // Else no height is farther from that of the middle than the steepest slope allows.
        const V cx = centre(args[0]), cz = centre(args[1]), rx = radius(args[0]), rz = radius(args[1]);
        const float corner = abs(grid[SampledGrid::low]) + abs(grid[SampledGrid::low + 1]);
        const V ulps = (abs(cx) + abs(cz) + V(corner)) * 4e-7f;
        const V reach = (sqrt(rx * rx + rz * rz) * 1.000001f + ulps) * grid[HeightWords::steepness];
        const V middle = at(cx, cz);
        const V least = select(oneCell, min(min(h00, h10), min(h01, h11)), middle - reach);
        const V most = select(oneCell, max(max(h00, h10), max(h01, h11)), middle + reach);
        return I{max(squares.least, least) - slack, min(squares.most, most) + slack};
    }

    template <class D>
    static D gradient(std::span<const D> args, const float* grid) {
        using V = typename D::Value;
        const Place<V> x = place(args[0].value, grid, 0), z = place(args[1].value, grid, 1);
        const Patch<V> h = patch(x, z, grid);
        const float perMetre = grid[SampledGrid::inverseCell];
        const V dx = slopeOf(x, h.dx * perMetre), dz = slopeOf(z, h.dz * perMetre);
        const auto along = [&](const V& a, const V& b) { return dx * a + dz * b; };
        return D{h.height, along(args[0].dx, args[1].dx), along(args[0].dy, args[1].dy), along(args[0].dz, args[1].dz)};
    }

private:
    /// Where a coordinate lies: its cell, its share of the cell, and whether it is beyond the lattice.
    template <class V>
    struct Place {
        V cell, share;
        MaskOf<V> below, above;
    };
    /// The first and the last cell that a range of a coordinate meets.
    template <class V>
    struct Span {
        V first, last;
    };
    /// A height and its derivatives by shares of a cell.
    template <class V>
    struct Patch {
        V height, dx, dz;
    };

    template <class V>
    static V slopeOf(const Place<V>& at, const V& slope) {
        return select(at.below, V(0.0f), select(at.above, V(0.0f), slope));
    }
    template <class V>
    struct Bounds {
        V least, most;
    };

    /// The heights of the smallest squares two of which, along each axis, hold those cells.
    template <class V>
    static Bounds<V> ofSquares(const Span<V>& x, const Span<V>& z, const float* grid) {
        const V extent = max(x.last - x.first, z.last - z.first);
        const float top = grid[HeightWords::levels] - 1;
        V level(0.0f);
        float size = 2;
        for (float k = 0; k < top; ++k, size *= 2) level = level + select(extent > V(size), V(1.0f), V(0.0f));
        const V scale = powerOfTwo(V(-1.0f) - level);
        const V i0 = floor(x.first * scale), i1 = floor(x.last * scale), k0 = floor(z.first * scale),
                k1 = floor(z.last * scale);
        const auto number = toInt(level);
        const auto begin = toInt(gather(grid + HeightWords::firstOf, number));
        const auto width = toInt(gather(grid + HeightWords::widthOf, number));
        const auto at = [&](const V& i, const V& k) {
            const auto square = toInt(i) + toInt(k) * width;
            return begin + square + square;
        };
        const auto a = at(i0, k0), b = at(i1, k0), c = at(i0, k1), d = at(i1, k1);
        return {min(min(gather(grid, a), gather(grid, b)), min(gather(grid, c), gather(grid, d))),
                max(max(gather(grid + 1, a), gather(grid + 1, b)), max(gather(grid + 1, c), gather(grid + 1, d)))};
    }
    /// In cells from the low border, held within the lattice; a NaN becomes a number: what it reads is there.
    template <class V>
    static V within(const V& p, const float* grid, size_t axis) {
        const V u = (p - V(grid[SampledGrid::low + axis])) * V(grid[SampledGrid::inverseCell]);
        return max(min(u, V(grid[SampledGrid::cells + axis])), V(0.0f));
    }
    template <class V>
    static V cellOf(const V& u, const float* grid, size_t axis) {
        return min(floor(u), V(grid[SampledGrid::cells + axis] - 1));
    }
    template <class V>
    static Span<V> cellsOf(const V& lo, const V& hi, const float* grid, size_t axis) {
        return {cellOf<V>(within<V>(lo, grid, axis), grid, axis), cellOf<V>(within<V>(hi, grid, axis), grid, axis)};
    }
    template <class V>
    static Place<V> place(const V& p, const float* grid, size_t axis) {
        const V u = within<V>(p, grid, axis), cell = cellOf<V>(u, grid, axis);
        const V free = (p - V(grid[SampledGrid::low + axis])) * V(grid[SampledGrid::inverseCell]);
        return {cell, u - cell, free<V(0.0f), free> V(grid[SampledGrid::cells + axis])};
    }
    template <class V>
    static Patch<V> patch(const Place<V>& x, const Place<V>& z, const float* grid) {
        using Int = IntOf<V>;
        const auto row = static_cast<uint32_t>(grid[SampledGrid::nodesX]);
        const Int at = toInt(x.cell) + toInt(z.cell) * Int(row);
        const float* heights = grid + HeightWords::firstHeight;
        const V h00 = gather(heights, at), h01 = gather(heights + row, at);
        const V d0 = gather(heights + 1, at) - h00, d1 = gather(heights + row + 1, at) - h01;
        const V near = h00 + x.share * d0, far = h01 + x.share * d1;
        return {near + z.share * (far - near), d0 + z.share * (d1 - d0), far - near};
    }
};

}  // namespace sgm::field::ops
