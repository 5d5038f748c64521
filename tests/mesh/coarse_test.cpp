#include <gtest/gtest.h>

#include <cstring>

#include "modeler/mesh/coarse_loops.h"
#include "modeler/mesh/region.h"
#include "tests/mesh/scenes.h"

namespace sgm::mesh {
namespace {

/// Edges of the grid whose ends differ in sign, all corners asked; those on the border count as outside.
size_t cutEdges(const eval::Tape& tape, const Grid& grid) {
    const Vec3i n = grid.cells + Vec3i{1, 1, 1};
    std::vector<float> x, y, z;
    for (int k = 0; k < n.z; ++k)
        for (int j = 0; j < n.y; ++j)
            for (int i = 0; i < n.x; ++i) {
                const Vec3f p = grid.corner(i, j, k);
                x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
            }
    std::vector<float> f(x.size());
    eval::Workspace workspace;
    eval::evaluate(tape, {x.data(), y.data(), z.data(), f.size()}, f.data(), workspace);
    const auto inside = [&](Vec3i c) {
        if (minComponent(c) == 0 || minComponent(grid.cells - c) == 0) return false;
        return f[static_cast<size_t>(c.x + n.x * (c.y + n.y * c.z))] < 0;
    };
    size_t cut = 0;
    for (int k = 0; k < n.z; ++k)
        for (int j = 0; j < n.y; ++j)
            for (int i = 0; i < n.x; ++i)
                for (int axis = 0; axis < 3; ++axis) {
                    Vec3i other{i, j, k};
                    if (++other[axis] < n[axis]) cut += inside({i, j, k}) != inside(other);
                }
    return cut;
}

size_t vertices(const Mesh& mesh) {
    size_t all = 0;
    for (const Chunk& c : mesh.chunks) all += c.positions.size();
    return all;
}

TEST(Coarse, NoCutEdgeOfAFractalIsMissed) {
    const Scene s = fractal();
    ASSERT_TRUE(isExpensive(s.tape()));
    for (const int resolution : {40, 75, 130}) {
        const BuiltMesh m = meshOf(s, resolution);
        ASSERT_TRUE(m.mesh.ok());
        EXPECT_EQ(vertices(*m.mesh), cutEdges(s.tape(), m.grid));
    }
}

TEST(Coarse, AGridThatCutsThroughTheFractalStillCloses) {
    const Scene s = fractal();
    const Grid grid{{-0.913f, -0.71f, -1.03f}, 0.0171f, {101, 90, 77}};
    const BuiltMesh m = meshOf(s.tape(), grid);
    ASSERT_TRUE(m.mesh.ok());
    EXPECT_EQ(vertices(*m.mesh), cutEdges(s.tape(), grid));
}

TEST(Coarse, MostCornersOfAThinFractalAreNotAsked) {
    const BuiltMesh m = meshOf(fractal(), 256);
    ASSERT_TRUE(m.mesh.ok());
    EXPECT_LT(double(m.counts.pointEvaluations), 6.0 * double(m.counts.surfaceCells));
}

/// Every instruction set's loops do the same.
TEST(Coarse, LoopsAgree) {
    std::vector<const CoarseLoops*> all{&portable::coarseLoops};
#if defined(__x86_64__)
    if (eval::bestIsa() != eval::Isa::Portable) all.push_back(&avx2::coarseLoops);
    if (eval::bestIsa() == eval::Isa::Avx512) all.push_back(&avx512::coarseLoops);
#endif
    constexpr size_t n = coarseCorners;
    for (uint64_t trial = 0; trial < 200; ++trial) {
        std::vector<float> coarse(n * n * n + 16);
        for (size_t i = 0; i < n * n * n; ++i)
            coarse[i] = static_cast<float>(uniform(combine(trial, i), -3, 3) * (trial % 4 == 0 ? 1 : 0.8));
        if (trial % 5 == 0) coarse[trial % (n * n * n)] = std::numeric_limits<float>::quiet_NaN();
        std::vector<Between> found(all.size());
        std::vector<std::vector<float>> values(all.size(), std::vector<float>(9 * 9 * 9 + 16, 0.0f));
        for (size_t a = 0; a < all.size(); ++a) {
            const bool some = all[a]->find(coarse.data(), n, n * n, {1.5f, 2, 2.5f}, found[a]);
            all[a]->fill(coarse.data(), n, n * n, found[a], values[a].data(), 9, 81);
            std::vector<float> along(9 + 16), x(9 * 9 * 9 + 16), y = x, z = x;
            for (size_t i = 0; i < 9; ++i) along[i] = static_cast<float>(i);
            const size_t points =
                all[a]->gather(found[a], along.data(), along.data(), along.data(), x.data(), y.data(), z.data());
            EXPECT_EQ(points > 0, some);
            for (size_t i = 0; i < points; ++i) x[i] += 10 * y[i] + 100 * z[i];
            all[a]->scatter(found[a], x.data(), values[a].data(), 9, 81);
            EXPECT_EQ(std::memcmp(values[a].data(), values[0].data(), 9 * 9 * 9 * sizeof(float)), 0);
            for (int row = 0; row < 81; ++row) EXPECT_EQ(found[a].needed[row], found[0].needed[row]);
        }
    }
}

}  // namespace
}  // namespace sgm::mesh
