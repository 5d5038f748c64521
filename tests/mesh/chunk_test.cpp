// Blocks to chunks one by one, and how seams are named.
#include "modeler/mesh/chunk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/mesh/scenes.h"

namespace sgm::mesh {
namespace {

TEST(Chunk, DependsOnItsBlockAlone) {
    const Scene s = cloudScene(40, 0.2f, 4);
    const Grid grid = gridFor(s.field.bounds, cellFor(s.field.bounds, 90));
    Counts counts;
    const auto blocks = subdivide(s.tape(), grid, 1, nullptr, counts);
    const Mesh whole = *polygonize(*blocks, grid, {.threads = 1}, nullptr, counts);
    size_t at = 0;
    for (size_t b = blocks->size(); b-- > 0;) {  // in another order, each by a mesher of its own
        Chunk chunk;
        ASSERT_TRUE(BlockMesher(grid, PolygonizeOptions{}).mesh((*blocks)[b], nullptr, chunk));
        const auto same = std::find_if(whole.chunks.begin(), whole.chunks.end(),
                                       [&](const Chunk& c) { return c.block == chunk.block; });
        if (chunk.triangles.empty()) continue;
        ASSERT_NE(same, whole.chunks.end());
        EXPECT_EQ(chunk.positions, same->positions);
        EXPECT_EQ(chunk.normals, same->normals);
        EXPECT_EQ(chunk.triangles, same->triangles);
        EXPECT_EQ(chunk.origins, same->origins);
        EXPECT_EQ(chunk.shared.vertices, same->shared.vertices);
        ++at;
    }
    EXPECT_EQ(at, whole.chunks.size());
    EXPECT_GT(at, 20u);
}

/// Where a scene's vertices are on a grid, ascending.
std::vector<std::array<float, 3>> verticesOf(const Scene& s, const Grid& grid) {
    Counts counts;
    const auto blocks = subdivide(s.tape(), grid, 1, nullptr, counts);
    const Mesh mesh = *polygonize(*blocks, grid, {.threads = 1}, nullptr, counts);
    std::vector<std::array<float, 3>> all;
    for (const Chunk& c : mesh.chunks)
        for (const Vec3f& p : c.positions) all.push_back({p.x, p.y, p.z});
    std::sort(all.begin(), all.end());
    return all;
}

TEST(Chunk, VerticesThatWaitForTheNextBricksAreTheSame) {
    // A ball's bricks all have its tape; with others around it, in the same blocks, bricks have tapes of their own.
    Scene alone, among;
    const auto ballOf = [](Scene& s) { return field::Owned{ball(s.graph, {}, 1), 1}; };
    const field::Owned one[] = {ballOf(alone)};
    alone.field = field::sum(alone.graph, one);
    std::vector<field::Owned> parts{ballOf(among)};
    for (int i = 0; i < 60; ++i) {
        const float z = static_cast<float>(2 * i + 1) / 60 - 1, turn = 2.4f * static_cast<float>(i),
                    r = std::sqrt(1 - z * z);
        parts.push_back({ball(among.graph, Vec3f{r * std::cos(turn), r * std::sin(turn), z} * 1.4f, 0.05f), 2});
    }
    among.field = field::sum(among.graph, parts);
    const Grid grid = gridFor(among.field.bounds, 1 / 32.0f);
    const auto some = verticesOf(alone, grid), all = verticesOf(among, grid);
    ASSERT_GT(some.size(), 10000u);
    EXPECT_GT(all.size(), some.size());
    EXPECT_TRUE(std::includes(all.begin(), all.end(), some.begin(), some.end()));
}

TEST(Chunk, BorrowedVerticesLieOnTheSharedSide) {
    const BuiltMesh m = meshOf(cloudScene(40, 0.2f, 4), 90);
    std::vector<Vec3f> positions;
    for (const Chunk& c : m.mesh.value().chunks)
        positions.insert(positions.end(), c.positions.begin(), c.positions.end());
    size_t ghosts = 0;
    for (const Chunk& c : m.mesh->chunks)
        for (int kind = 0; kind < seamKinds; ++kind)
            for (uint32_t i = c.ghosts.begin[kind]; i < c.ghosts.begin[kind + 1]; ++i, ++ghosts) {
                ASSERT_LT(c.ghosts.vertices[i], c.firstVertex) << "lower blocks own what is shared";
                const Vec3f p = positions[c.ghosts.vertices[i]];
                const Vec3f side = m.grid.corner(32 * c.block.x, 32 * c.block.y, 32 * c.block.z);
                for (int axis = 0; axis < 3; ++axis)
                    ASSERT_TRUE(p[axis] == side[axis] || ((kind + 1) >> axis & 1) == 0);
            }
    EXPECT_GT(ghosts, 1000u);
}

TEST(Chunk, VerticesAtCreasesFindTheSurface) {
    // Balls that cut each other: along an edge across the crease the field is bent.
    Scene s;
    const field::Owned parts[] = {{ball(s.graph, {-0.5f, 0, 0}, 1), 1}, {ball(s.graph, {0.53f, 0.1f, 0}, 1), 2}};
    s.field = field::sum(s.graph, parts);
    const BuiltMesh m = meshOf(s, 60);
    double worst = 0, sum = 0;
    for (const Chunk& c : m.mesh.value().chunks)
        for (size_t i = 0; i < c.positions.size(); ++i) {
            const Vec3d p = c.positions[i].as<double>();
            const double f =
                std::min(length(p - Vec3d{-0.5, 0, 0}), length(p - Vec3d{double(0.53f), double(0.1f), 0})) - 1;
            worst = std::max(worst, std::abs(f) / m.grid.cell_m);
            sum += f * f / (m.grid.cell_m * m.grid.cell_m);
        }
    EXPECT_LT(std::sqrt(sum / static_cast<double>(m.mesh->vertexCount())), 1e-4);
    EXPECT_LT(worst, 2e-3);
}

}  // namespace
}  // namespace sgm::mesh
