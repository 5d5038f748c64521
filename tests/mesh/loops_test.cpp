// The mesher's loops give the same on every instruction set that this machine has.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "modeler/core/random.h"
#include "modeler/eval/evaluate.h"
#include "modeler/mesh/brick_loops.h"
#include "modeler/mesh/edge_loops.h"

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

TEST(Loops, OpenEntriesAreListedPickedAndPutBack) {
    constexpr size_t n = 203;
    Samples f = randomSamples(3);
    for (size_t i = 0; i < n; ++i)
        if (f[i] < 0.2f) f[i] = 0;
    for (const Loops& l : loopsHere()) {
        std::vector<uint32_t> list(n + 1);
        const size_t open = l.edges->listOpen(f.data(), 5, n, list.data());
        Samples picked{}, back{};
        l.edges->pick(f.data(), list.data(), open, picked.data());
        l.edges->putBack(picked.data(), list.data(), open, back.data());
        for (size_t i = 0; i < n; ++i) EXPECT_EQ(back[i], i < 5 ? 0.0f : f[i]) << i;
    }
}

}  // namespace
}  // namespace sgm::mesh
