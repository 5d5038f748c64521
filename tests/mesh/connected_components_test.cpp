// Separate solids of a mesh: cavities are no solids, and what hangs in the air floats.
#include "modeler/mesh/connected_components.h"

#include <gtest/gtest.h>

#include <numbers>

#include "modeler/mesh/chunk.h"
#include "modeler/mesh/validate.h"
#include "tests/mesh/mesh_bytes.h"
#include "tests/mesh/scenes.h"

namespace sgm::mesh {
namespace {

/// The mesh of a scene at cells of 1/8 m.
Mesh meshed(const Scene& s) {
    const eval::Tape tape = s.tape();
    const Grid grid = gridFor(s.field.bounds, 0.125f);
    Counts counts;
    const auto blocks = subdivide(tape, grid, 1, nullptr, counts);
    return *polygonize(*blocks, grid, {.threads = 1}, nullptr, counts);
}

TEST(Pieces, ABallInACavityFloatsAndTheCavityIsNoPiece) {
    Scene s;
    auto& g = s.graph;
    const field::Field rock = field::difference({box(g, {0, 4, 0}, {4, 4, 4}), 1}, {ball(g, {0, 4, 0}, 3), 1});
    const field::Owned parts[] = {{rock, 1}, {ball(g, {0, 5, 0}, 1), 2}, {box(g, {7, 1, 0}, {1, 1, 1}), 3}};
    s.field = field::sum(g, parts);
    const auto found = connectedComponents(meshed(s), 0.125f);
    ASSERT_EQ(found.size(), 3u);
    uint64_t floating = 0;
    for (const ConnectedComponent& p : found) {
        floating += p.floats;
        if (!p.floats) continue;
        ASSERT_FALSE(p.origins.empty());
        EXPECT_EQ(p.origins[0], 2u);
        EXPECT_NEAR(p.volume_m3, 4 * std::numbers::pi / 3, 0.1);
        EXPECT_NEAR(p.bounds.lo.y, 4, 0.02);
    }
    EXPECT_EQ(floating, 1u);  // the box beside the rock stands on the same ground
}

TEST(Pieces, TheGreatestFloatsUnlessOnlyDebrisStands) {
    for (const float half : {1.0f, 0.3f}) {
        Scene s;
        const field::Owned parts[] = {{box(s.graph, {0, half, 0}, {half, half, half}), 1},
                                      {box(s.graph, {0, 8, 0}, {2, 2, 2}), 2}};
        s.field = field::sum(s.graph, parts);
        Mesh mesh = meshed(s);
        const auto found = connectedComponents(mesh, 0.125f);
        ASSERT_EQ(found.size(), 2u);
        const bool debris = half < 1;
        for (const ConnectedComponent& p : found) EXPECT_EQ(p.floats, !debris && p.volume_m3 > 30) << half;
        keepOnly(mesh, Keep::Grounded, 0.125f);
        const auto kept = connectedComponents(mesh, 0.125f);
        ASSERT_EQ(kept.size(), debris ? 2u : 1u);
        EXPECT_NEAR(kept[0].bounds.lo.y, 0, 0.02);
    }
}

TEST(Pieces, KeepLeavesClosedSolidsAndFillsCavities) {
    Scene s;
    auto& g = s.graph;
    const field::Field rock = field::difference({box(g, {0, 4, 0}, {4, 4, 4}), 1}, {ball(g, {0, 4, 0}, 3), 1});
    const field::Owned parts[] = {
        {rock, 1}, {ball(g, {0, 5, 0}, 1), 2}, {box(g, {7, 1, 0}, {1, 1, 1}), 3}, {ball(g, {7, 0.2f, 3}, 0.2f), 4}};
    s.field = field::sum(g, parts);
    const Mesh whole = meshed(s);
    for (const Keep keep : {Keep::All, Keep::Grounded, Keep::Largest}) {
        Mesh mesh = whole;
        const Dropped dropped = keepOnly(mesh, keep, 0.125f);
        const MeshFigures f = measure(mesh);
        EXPECT_EQ(f.boundaryEdges + f.nonmanifoldEdges, 0u);
        EXPECT_EQ(f.components, keep == Keep::All ? 5u : keep == Keep::Grounded ? 2u : 1u);
        EXPECT_EQ(dropped.cavities, keep == Keep::All ? 0u : 1u);
        EXPECT_EQ(dropped.pieces, keep == Keep::All        ? 0u
                                  : keep == Keep::Grounded ? 2u
                                                           : 3u)
            << "the ball in the air, the crumb, the box";
        if (keep == Keep::Largest) {
            EXPECT_NEAR(f.volume_m3, 512, 1);
        }
        uint32_t next = 0;
        for (const Chunk& c : mesh.chunks) {
            EXPECT_EQ(c.firstVertex, next);
            next += static_cast<uint32_t>(c.positions.size());
            EXPECT_EQ(c.normals.size(), c.positions.size());
        }
    }
}

TEST(Pieces, OfManyBlocksAreThoseOfTheWhole) {
    for (uint64_t key = 0; key < 4; ++key) {
        const Scene s = cloudScene(60, 0.08f, key);
        const Mesh mesh = *meshOf(s, 150).mesh;
        ASSERT_GT(mesh.chunks.size(), 20u);
        const MeshFigures whole = measure(mesh);
        const auto found = connectedComponents(mesh, 0);
        EXPECT_EQ(found.size(), whole.components) << "no cavity in a cloud of balls";
        uint64_t triangles = 0;
        double volume_m3 = 0;
        Box3f bounds;
        for (const ConnectedComponent& p : found)
            triangles += p.triangles, volume_m3 += p.volume_m3, bounds = hull(bounds, p.bounds);
        EXPECT_EQ(triangles, mesh.triangleCount());
        EXPECT_NEAR(volume_m3, whole.volume_m3, 1e-9);
        EXPECT_EQ(bounds, mesh.bounds());
    }
}

TEST(Pieces, KeepLeavesTheSameSeamsAtAnyThreadCountAndOfABareMeshTheSameShape) {
    for (uint64_t key = 0; key < 4; ++key) {
        const Scene s = cloudScene(60, 0.08f, key);
        Mesh full = *meshOf(s, 150).mesh, again = full,
             positionsOnly = *meshOf(s, 150, 2, {.positionsOnly = true}).mesh;
        ASSERT_GT(keepOnly(full, Keep::Largest, 0, 1).pieces, 3u);
        keepOnly(again, Keep::Largest, 0, 3);
        EXPECT_EQ(bytesOf(again), bytesOf(full));
        keepOnly(positionsOnly, Keep::Largest, 0);
        EXPECT_FALSE(full.hasPositionsOnly());
        for (Chunk& c : again.chunks) {
            for (int kind = 0; kind < seamKinds; ++kind) {
                const uint32_t first = c.ghosts.begin[kind], count = c.ghosts.begin[kind + 1] - first;
                if (count == 0) continue;
                const Chunk& lender = ownerOf(again.chunks, c.ghosts.vertices[first]);
                ASSERT_EQ(lender.shared.begin[kind + 1] - lender.shared.begin[kind], count)
                    << "both sides of a seam list the same vertices";
                for (uint32_t i = 0; i < count; ++i)
                    EXPECT_EQ(c.ghosts.vertices[first + i],
                              lender.firstVertex + lender.shared.vertices[lender.shared.begin[kind] + i]);
            }
            c.normals.clear(), c.origins.clear();
        }
        EXPECT_EQ(bytesOf(positionsOnly), bytesOf(again));
        const MeshFigures f = measure(full);
        EXPECT_EQ(f.components, 1u);
        EXPECT_EQ(f.boundaryEdges + f.nonmanifoldEdges, 0u);
    }
}

TEST(Pieces, WhatTouchesIsOne) {
    Scene s;
    const field::Owned parts[] = {{box(s.graph, {0, 1, 0}, {1, 1, 1}), 1}, {ball(s.graph, {0, 2.5f, 0}, 1), 2}};
    s.field = field::sum(s.graph, parts);
    const auto found = connectedComponents(meshed(s), 0.125f);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_FALSE(found[0].floats);
    EXPECT_EQ(found[0].origins.size(), 2u);
    EXPECT_TRUE(connectedComponents({}, 0.1f).empty());
}

}  // namespace
}  // namespace sgm::mesh
