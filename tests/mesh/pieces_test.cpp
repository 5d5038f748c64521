// Separate solids of a mesh: cavities are no solids, and what hangs in the air floats.
#include "modeler/mesh/pieces.h"

#include <gtest/gtest.h>

#include <numbers>

#include "modeler/mesh/validate.h"
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
    const auto found = pieces(meshed(s), 0.125f);
    ASSERT_EQ(found.size(), 3u);
    uint64_t floating = 0;
    for (const Piece& p : found) {
        floating += p.floats;
        if (!p.floats) continue;
        ASSERT_FALSE(p.origins.empty());
        EXPECT_EQ(p.origins[0], 2u);
        EXPECT_NEAR(p.volume_m3, 4 * std::numbers::pi / 3, 0.1);
        EXPECT_NEAR(p.bounds.lo.y, 4, 0.02);
    }
    EXPECT_EQ(floating, 1u);  // the box beside the rock stands on the same ground
}

TEST(Pieces, KeepLeavesClosedSolidsAndFillsCavities) {
    Scene s;
    auto& g = s.graph;
    const field::Field rock = field::difference({box(g, {0, 4, 0}, {4, 4, 4}), 1}, {ball(g, {0, 4, 0}, 3), 1});
    const field::Owned parts[] = {{rock, 1}, {ball(g, {0, 5, 0}, 1), 2}, {box(g, {7, 1, 0}, {1, 1, 1}), 3}, {ball(g, {7, 0.2f, 3}, 0.2f), 4}};
    s.field = field::sum(g, parts);
    const Mesh whole = meshed(s);
    for (const Keep keep : {Keep::All, Keep::Grounded, Keep::Largest}) {
        Mesh mesh = whole;
        const Dropped dropped = keepOnly(mesh, keep, 0.125f);
        const MeshFigures f = measure(mesh);
        EXPECT_EQ(f.boundaryEdges + f.nonmanifoldEdges, 0u);
        EXPECT_EQ(f.components, keep == Keep::All ? 5u : keep == Keep::Grounded ? 2u : 1u);
        EXPECT_EQ(dropped.cavities, keep == Keep::All ? 0u : 1u);
        EXPECT_EQ(dropped.pieces, keep == Keep::All ? 0u : keep == Keep::Grounded ? 2u : 3u) << "the ball in the air, the crumb, the box";
        if (keep == Keep::Largest) { EXPECT_NEAR(f.volume_m3, 512, 1); }
        uint32_t next = 0;
        for (const Chunk& c : mesh.chunks) {
            EXPECT_EQ(c.firstVertex, next);
            next += static_cast<uint32_t>(c.positions.size());
            EXPECT_EQ(c.normals.size(), c.positions.size());
        }
    }
}

TEST(Pieces, WhatTouchesIsOne) {
    Scene s;
    const field::Owned parts[] = {{box(s.graph, {0, 1, 0}, {1, 1, 1}), 1}, {ball(s.graph, {0, 2.5f, 0}, 1), 2}};
    s.field = field::sum(s.graph, parts);
    const auto found = pieces(meshed(s), 0.125f);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_FALSE(found[0].floats);
    EXPECT_EQ(found[0].origins.size(), 2u);
    EXPECT_TRUE(pieces({}, 0.1f).empty());
}

}  // namespace
}  // namespace sgm::mesh
