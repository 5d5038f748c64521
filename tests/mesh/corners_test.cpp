// Corner normals: one table for a mesh, and what travels with its triangles when they are edited.
#include "modeler/mesh/corners.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "modeler/core/conventions.h"
#include "modeler/mesh/connected_components.h"
#include "modeler/mesh/edit.h"
#include "tests/hard_box.h"
#include "tests/mesh/scenes.h"

namespace sgm::mesh {
namespace {

Mesh twoBoxes() {
    return meshOfChunks({hardBox({0, 0, 0}, {}, {1, 1, 1}, 1), hardBox({9, 3, 0}, {}, {.5, .5, .5}, 2)});
}

TEST(Corners, EqualNormalsAreCollectedOnce) {
    const Mesh mesh = twoBoxes();
    const CornerNormalTable table = collectCornerNormals(mesh);
    EXPECT_EQ(table.normals.size(), 6u);
    ASSERT_EQ(table.of.size(), 24u);
    for (size_t t = 0; t < 24; ++t)
        for (int k = 0; k < 3; ++k) EXPECT_EQ(table.of[t][k], t % 12 / 2);
    Mesh smooth = mesh;
    for (Chunk& c : smooth.chunks) c.cornerNormals.clear();
    EXPECT_TRUE(collectCornerNormals(smooth).empty());
}

TEST(Corners, EveryEdgeOfAClosedMeshHasANeighbour) {
    const Scene s = cloudScene(10, 0.2f, 3);
    const Mesh mesh = *meshOf(s, 40).mesh;
    const auto triangles = gatherTriangles(mesh);
    const auto neighbours = findEdgeNeighbours(triangles, mesh.vertexCount());
    for (uint32_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            ASSERT_NE(neighbours[t][k], noIndex);
            const Triangle& u = triangles[neighbours[t][k]];
            int shared = 0;
            for (int j = 0; j < 3; ++j)
                shared += u[j] == triangles[t][(k + 1) % 3] && u[(j + 1) % 3] == triangles[t][k];
            ASSERT_EQ(shared, 1);
        }
    const std::vector<Triangle> alone{{0, 1, 2}};
    EXPECT_EQ(findEdgeNeighbours(alone, 3)[0], (Triangle{noIndex, noIndex, noIndex}));
}

TEST(Corners, SmoothingGroupsAreOneAFaceAndDifferWhereFacesMeet) {
    const Mesh mesh = twoBoxes();
    const auto triangles = gatherTriangles(mesh);
    const auto corners = collectCornerNormals(mesh);
    const auto groups =
        findSmoothingGroups(mesh, triangles, corners, findEdgeNeighbours(triangles, mesh.vertexCount()));
    for (size_t t = 0; t < 24; t += 2) EXPECT_EQ(groups[t], groups[t + 1]);
    for (size_t face = 0; face < 6; ++face)
        for (size_t other = 0; other < 6; ++other)
            if (face / 2 != other / 2) {
                EXPECT_NE(groups[2 * face], groups[2 * other]) << face << " meets " << other;
            }
    EXPECT_EQ(*std::max_element(groups.begin(), groups.end()), 3u) << "opposite faces never meet";
    const auto smooth = findSmoothingGroups(mesh, triangles, {}, {});
    EXPECT_EQ(std::set<uint32_t>(smooth.begin(), smooth.end()), std::set<uint32_t>{1});
}

/// Each corner's normal says which face of an axis-aligned box its triangle is, and the label says the same.
void expectFacesMatch(const Mesh& mesh, float outward) {
    const CornerNormalTable corners = collectCornerNormals(mesh);
    size_t t = 0;
    for (const Chunk& c : mesh.chunks) {
        ASSERT_EQ(c.labels.size(), c.triangles.size());
        for (size_t i = 0; i < c.triangles.size(); ++i, ++t) {
            const Triangle tri = c.triangles[i];
            const Vec3f a = c.positions[tri.x];
            const Vec3f n = normalized(cross(c.positions[tri.y] - a, c.positions[tri.z] - a));
            Vec3f face{};
            face[static_cast<int>(c.labels[i] / 2)] = c.labels[i] % 2 ? -outward : outward;
            EXPECT_EQ(n, face);
            for (int k = 0; k < 3; ++k) EXPECT_EQ(corners.normals[corners.of[t][k]], face);
        }
        for (size_t i = 1; i < c.cornerNormals.size(); ++i)
            EXPECT_LT(c.cornerNormals[i - 1].corner, c.cornerNormals[i].corner);
    }
}

TEST(Corners, TurnTheSurfaceRound) {
    Mesh mesh = twoBoxes();
    expectFacesMatch(mesh, 1);
    turnInsideOut(mesh);
    expectFacesMatch(mesh, -1);
}

TEST(Corners, StayWithTheTrianglesThatAreKept) {
    Chunk both = hardBox({0, 0, 0}, {}, {.5, .5, .5}, 2);
    const Chunk large = hardBox({9, 0, 0}, {}, {1, 1, 1}, 1);
    for (size_t i = 0; i < 12; ++i) {
        const Triangle t = large.triangles[i];
        both.triangles.push_back({t.x + 8, t.y + 8, t.z + 8});
        both.origins.push_back(1), both.labels.push_back(large.labels[i]);
    }
    for (const CornerNormal& n : large.cornerNormals) both.cornerNormals.push_back({n.corner + 36, n.normal});
    for (size_t v = 0; v < 8; ++v)
        both.positions.push_back(large.positions[v]), both.normals.push_back(large.normals[v]);
    Mesh mesh = meshOfChunks({both});
    EXPECT_EQ(keepOnly(mesh, Keep::Largest, 0.1f).pieces, 1u);
    ASSERT_EQ(mesh.triangleCount(), 12u);
    EXPECT_EQ(mesh.chunks[0].cornerNormals.size(), 36u);
    expectFacesMatch(mesh, 1);
}

}  // namespace
}  // namespace sgm::mesh
