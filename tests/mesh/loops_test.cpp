// The mesher's loops give the same on every instruction set that this machine has.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "modeler/core/random.h"
#include "modeler/eval/evaluate.h"
#include "modeler/mesh/brick_loops.h"
#include "modeler/mesh/vertices.h"

namespace sgm::mesh {
namespace {

struct Loops {
    const BrickLoops* bricks;
    const EdgeLoops* edges;
};

std::vector<Loops> loopsHere() {
    std::vector<Loops> all{{&portable::brickLoops, &portable::loops}};
#if defined(__x86_64__)
    if (eval::bestIsa() != eval::Isa::Portable) all.push_back({&avx2::brickLoops, &avx2::loops});
    if (eval::bestIsa() == eval::Isa::Avx512) all.push_back({&avx512::brickLoops, &avx512::loops});
#endif
    return all;
}

constexpr size_t side = 16;
using Samples = std::array<float, side * side * side>;

Samples randomSamples(uint64_t key) {
    Samples f;
    for (size_t i = 0; i < f.size(); ++i) f[i] = static_cast<float>(uniform(combine(key, i), -1, 1));
    return f;
}

TEST(Loops, RowsAreGatheredAndScattered) {
    const Samples from = randomSamples(1);
    const CornerRow rows[] = {
        {0, 0, 0, 0, 9}, {300, 1, 2, 3, 8}, {650, 4, 5, 6, 3}, {700, 0, 7, 8, 9}, {900, 8, 8, 8, 1}};
    constexpr size_t points = 9 + 8 + 3 + 9 + 1;
    for (const Loops& l : loopsHere()) {
        Samples x{}, y{}, z{}, values{};
        l.bricks->gather(rows, std::size(rows), from.data(), from.data() + 50, from.data() + 100, x.data(), y.data(),
                         z.data());
        l.bricks->scatter(rows, std::size(rows), x.data(), values.data());
        size_t p = 0, written = 0;
        for (const CornerRow& row : rows)
            for (int i = 0; i < row.count; ++i, ++p) {
                EXPECT_EQ(x[p], from[row.i + static_cast<size_t>(i)]);
                EXPECT_EQ(y[p], from[50 + row.j]);
                EXPECT_EQ(z[p], from[100 + row.k]);
                EXPECT_EQ(values[row.corner + static_cast<size_t>(i)], x[p]);
            }
        EXPECT_EQ(p, points);
        for (const float v : values) written += v != 0.0f;
        EXPECT_EQ(written, points);  // and nothing beside the rows
    }
}

TEST(Loops, BitsTellWhichCornersAreInside) {
    Samples f = randomSamples(2);
    f[3] = 0.0f, f[4] = -0.0f, f[5] = std::numeric_limits<float>::quiet_NaN();
    for (const Loops& l : loopsHere()) {
        std::array<uint16_t, 81> bits{};
        l.bricks->inside(f.data(), side, side * side, bits.data());
        for (size_t row = 0; row < bits.size(); ++row)
            for (size_t i = 0; i < 16; ++i)
                EXPECT_EQ(bits[row] >> i & 1, i < 9 && f[i + side * (row % 9 + side * (row / 9))] < 0)
                    << row << ' ' << i;
    }
}

TEST(Loops, CutEdgesHaveOneEndInside) {
    std::array<uint16_t, 112> inside, edges;
    for (size_t row = 0; row < inside.size(); ++row) {
        inside[row] = static_cast<uint16_t>(combine(11, row) & 0x1ff);
        edges[row] = static_cast<uint16_t>(combine(12, row) & combine(13, row) & (row / 4 % 3 == 0 ? 0 : 0x1ff));
    }
    constexpr std::pair<int, int> ways[] = {{0, 1}, {1, 0}, {9, 0}};  // rows up, bits up
    for (const Loops& l : loopsHere())
        for (const auto& [up, shift] : ways) {
            std::array<uint16_t, cutRows> cut;
            const uint32_t groups = l.bricks->cut(inside.data(), up, shift, edges.data(), cut.data());
            for (size_t row = 0; row < cut.size(); ++row) {
                const int other = inside[row + static_cast<size_t>(up)] >> shift;
                EXPECT_EQ(cut[row], (inside[row] ^ other) & edges[row]) << row;
                EXPECT_TRUE(cut[row] == 0 || (groups >> row / 4 & 1)) << row;
            }
            EXPECT_EQ(groups & 0x249249u, 0u);  // groups without edges
        }
}

TEST(Loops, TrianglesBelongToMostOfTheirCorners) {
    constexpr uint32_t own = 20, ghosts = 0x80000000u;
    std::array<uint32_t, own + 12> origins;
    for (size_t i = 0; i < origins.size(); ++i) origins[i] = static_cast<uint32_t>(combine(21, i) % 4);
    for (size_t n = 0; n < 40; ++n) {
        std::vector<uint32_t> triangles(3 * n);
        for (size_t i = 0; i < triangles.size(); ++i) {
            const auto any = static_cast<uint32_t>(combine(n, i) % origins.size());
            triangles[i] = any < own ? any : ghosts | (any - own);
        }
        const auto of = [&](size_t i) {
            return origins[triangles[i] & ghosts ? own + (triangles[i] & ~ghosts) : triangles[i]];
        };
        for (const Loops& l : loopsHere()) {
            std::vector<uint32_t> owners(n + 1, 77);
            l.bricks->owners(triangles.data(), n, origins.data(), own, owners.data());
            for (size_t t = 0; t < n; ++t) {
                const uint32_t a = of(3 * t), b = of(3 * t + 1), c = of(3 * t + 2);
                EXPECT_EQ(owners[t], a == b || a == c ? a : b == c ? b : std::min({a, b, c}));
            }
            EXPECT_EQ(owners[n], 77u);  // and nothing beside them
        }
    }
}

/// Whether corners of a brick are inside, by chance or all along a plane.
struct Corners {
    std::array<uint8_t, 112> low{}, high{};
    uint64_t seed;

    explicit Corners(uint64_t seed) : seed(seed) {
        for (int k = 0; k < 9; ++k)
            for (int j = 0; j < 9; ++j)
                for (int i = 0; i < 9; ++i) {
                    if (!isIn(i, j, k)) continue;
                    const auto row = static_cast<size_t>(j + 9 * k);
                    if (i < 8) low[row] |= static_cast<uint8_t>(1 << i);
                    if (i > 0) high[row] |= static_cast<uint8_t>(1 << (i - 1));
                }
    }
    bool isIn(int i, int j, int k) const {
        return seed == 0 ? i + 2 * j + k < 14 : uniform(combine(combine(seed, i), combine(j, k)), 0, 1) < 0.5;
    }
};

TEST(Loops, OwnEdgesAreListedInOrder) {
    for (uint64_t seed = 0; seed < 3; ++seed) {
        const Corners c(seed);
        std::vector<uint32_t> expected;
        for (int axis = 0; axis < 3; ++axis)
            for (int k = axis != 2; k < 8 + (axis != 2); ++k)
                for (int j = axis != 1; j < 8 + (axis != 1); ++j)
                    for (int i = axis != 0; i < 8 + (axis != 0); ++i)
                        if (c.isIn(i, j, k) != c.isIn(i + (axis == 0), j + (axis == 1), k + (axis == 2)))
                            expected.push_back(codeOf(i, j, k, axis));
        for (const Loops& l : loopsHere()) {
            std::vector<uint32_t> codes(3 * 512 + rowPadding, 1u);
            ASSERT_EQ(l.bricks->ownEdges(c.low.data(), c.high.data(), codes.data()), expected.size());
            for (size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(codes[i], expected[i]);
            for (size_t i = expected.size(); i < wholeVectors(expected.size()); ++i) EXPECT_EQ(codes[i], 0u);
        }
    }
}

TEST(Loops, CellsAreListedWithTheirCases) {
    constexpr int rowStride = 33, layerStride = 1089, corner = 100;
    for (uint64_t seed = 0; seed < 3; ++seed) {
        const Corners in(seed);
        for (const Loops& l : loopsHere()) {
            std::vector<SurfaceCell> cells(512 + rowPadding);
            const size_t n =
                l.bricks->cells(in.low.data(), in.high.data(), corner, rowStride, layerStride, cells.data());
            size_t at = 0;
            for (int c = 0; c < 512; ++c) {
                const int i = c & 7, j = c >> 3 & 7, k = c >> 6;
                int inside = 0;
                for (int v = 0; v < 8; ++v) inside |= in.isIn(i + (v & 1), j + (v >> 1 & 1), k + (v >> 2)) << v;
                if (inside == 0 || inside == 255) continue;
                EXPECT_EQ(cells[at].corner, corner + i + j * rowStride + k * layerStride);
                EXPECT_EQ(cells[at++].inside, inside);
            }
            EXPECT_EQ(at, n);
        }
    }
}

TEST(Loops, TrianglesAreJoinedFromTheCellsRows) {
    constexpr size_t rowStride = 10, layerStride = 100;
    std::vector<uint32_t> number(3 * 10 * layerStride);
    for (size_t i = 0; i < number.size(); ++i) number[i] = static_cast<uint32_t>(1000 + i);
    std::array<PlacedCase, 6> cases{};
    for (size_t c = 1; c < cases.size(); ++c) {
        cases[c].triangles = static_cast<uint16_t>(c);
        for (size_t v = 0; v < 3 * c; ++v) {
            const size_t row = (v + c) % 4, place = v * 5 % 6;
            cases[c].lanes[v] = static_cast<uint8_t>(8 * row + place);
            cases[c].edges[v] = static_cast<int16_t>(3 * ((row & 1) * rowStride + (row >> 1) * layerStride) + place);
        }
    }
    for (const size_t n : {0, 1, 5, 6, 40}) {
        std::vector<SurfaceCell> cells;
        std::vector<uint32_t> expected;
        for (size_t c = 0; c < n; ++c) {
            const SurfaceCell cell{static_cast<uint16_t>(13 * c), static_cast<uint16_t>(1 + c % 5)};
            cells.push_back(cell);
            for (size_t v = 0; v < 3u * cases[cell.inside].triangles; ++v)
                expected.push_back(number[3u * cell.corner + static_cast<size_t>(cases[cell.inside].edges[v])]);
        }
        for (const Loops& l : loopsHere()) {
            std::vector<uint32_t> triangles(expected.size() + 16, 7u);
            l.bricks->join(cells.data(), n, number.data(), rowStride, layerStride, cases.data(), triangles.data());
            for (size_t i = 0; i < triangles.size(); ++i)
                EXPECT_EQ(triangles[i], i < expected.size() ? expected[i] : 7u) << n << ' ' << i;
        }
    }
}

/// Cut edges with anything in their arrays, and the arrays by number.
struct RandomEdges {
    CutEdges edges;
    std::vector<float*> rows;
    RandomEdges(size_t n, uint64_t key) {
        edges.reserve(n);
        const EdgeArrays& a = edges.arrays;
        rows = {a.x,    a.y,   a.z,   a.dx,   a.dy,   a.dz, a.f,    a.base,
                a.span, a.tIn, a.fIn, a.tOut, a.fOut, a.t,  a.open, a.axis};
        for (size_t r = 0; r < rows.size(); ++r)
            for (size_t i = 0; i < wholeVectors(n); ++i)
                rows[r][i] = static_cast<float>(uniform(combine(combine(key, r), i), r == 8 ? 0.1 : -1, 1));
        for (size_t i = 0; i < wholeVectors(n); ++i) a.axis[i] = static_cast<float>(i % 3);
    }
};

TEST(Loops, EdgesArePlacedBetweenTheirEnds) {
    const Samples at = randomSamples(9), values = randomSamples(10);
    const EdgeEnds ends{
        {at.data(), at.data() + 20, at.data() + 40}, values.data(), {1, side, side * side}, {1, 30, 900}};
    for (const size_t n : {1, 16, 37})
        for (const Loops& l : loopsHere()) {
            CutEdges edges;
            edges.reserve(n);
            std::vector<uint32_t> codes(wholeVectors(n)), places(wholeVectors(n));
            for (uint32_t e = 0; e < n; ++e) codes[e] = codeOf(e % 9, e * 5 % 9, e * 7 % 9, e % 3);
            l.edges->place(ends, codes.data(), n, edges.arrays, places.data());
            for (uint32_t e = 0; e < n; ++e) {
                const std::array<uint32_t, 3> corner{e % 9, e * 5 % 9, e * 7 % 9};
                const uint32_t axis = e % 3, number = corner[0] + side * (corner[1] + side * corner[2]);
                const float* const along = ends.coordinates[axis] + corner[axis];
                const EdgeArrays& a = edges.arrays;
                EXPECT_EQ(a.x[e], ends.coordinates[0][corner[0]]);
                EXPECT_EQ(a.y[e], ends.coordinates[1][corner[1]]);
                EXPECT_EQ(a.z[e], ends.coordinates[2][corner[2]]);
                EXPECT_EQ(a.base[e], along[0]);
                EXPECT_EQ(a.span[e], along[1] - along[0]);
                EXPECT_EQ(a.fIn[e], values[number]);
                EXPECT_EQ(a.fOut[e], values[number + ends.strides[axis]]);
                EXPECT_EQ(a.axis[e], static_cast<float>(axis));
                EXPECT_EQ(places[e], 3 * (corner[0] + 30 * corner[1] + 900 * corner[2]) + axis);
            }
        }
}

TEST(Loops, EdgesMoveTheSameWay) {
    constexpr size_t n = 203;
    RandomEdges expected(n, 5);
    portable::loops.interpolate(expected.edges.arrays, n);
    const size_t open = portable::loops.step(expected.edges.arrays, n);
    const size_t flat = portable::loops.normalize(expected.edges.arrays, n);
    EXPECT_GT(open, 0u);
    EXPECT_LT(open, n);
    for (const Loops& l : loopsHere()) {
        RandomEdges here(n, 5);
        l.edges->interpolate(here.edges.arrays, n);
        EXPECT_EQ(l.edges->step(here.edges.arrays, n), open);
        EXPECT_EQ(l.edges->normalize(here.edges.arrays, n), flat);
        for (size_t r = 0; r < here.rows.size(); ++r)
            for (size_t i = 0; i < n; ++i) ASSERT_EQ(here.rows[r][i], expected.rows[r][i]) << r << ' ' << i;
    }
}

TEST(Loops, OpenEntriesArePickedAndPutBack) {
    constexpr size_t n = 203;
    for (const Loops& l : loopsHere()) {
        RandomEdges from(n, 3), to(n, 4), back(n, 6);
        float* const open = from.edges.arrays.open;
        for (size_t i = 0; i < wholeVectors(n); ++i) open[i] = i < n && open[i] > 0.2f ? 1.0f : 0.0f;
        const size_t count = l.edges->pick(from.edges.arrays, n, to.edges.arrays);
        std::copy_n(open, wholeVectors(n), back.edges.arrays.open);
        l.edges->putBack(to.edges.arrays, n, back.edges.arrays);
        const RandomEdges before(n, 6);
        size_t c = 0;
        for (size_t i = 0; i < n; ++i) {
            if (open[i] == 0) {
                EXPECT_EQ(back.edges.arrays.x[i], before.edges.arrays.x[i]);
                continue;
            }
            EXPECT_EQ(to.edges.arrays.fOut[c], from.edges.arrays.fOut[i]);
            EXPECT_EQ(to.edges.arrays.axis[c], from.edges.arrays.axis[i]);
            EXPECT_EQ(back.edges.arrays.x[i], from.edges.arrays.x[i]);
            EXPECT_EQ(back.edges.arrays.dz[i], to.edges.arrays.dz[c]);
            ++c;
        }
        EXPECT_EQ(c, count);
    }
}

TEST(Loops, PointsAreInterleaved) {
    const Samples from = randomSamples(8);
    for (const Loops& l : loopsHere()) {
        Samples points{};
        l.edges->interleave(from.data(), from.data() + 100, from.data() + 200, 37, points.data());
        for (size_t i = 0; i < points.size(); ++i)
            EXPECT_EQ(points[i], i < 3 * 37 ? from[i / 3 + 100 * (i % 3)] : 0.0f) << i;
    }
}

}  // namespace
}  // namespace sgm::mesh
