// OpenMesh round trip, smoothing and decimation.
#include "modeler/mesh/edit.h"

#include <gtest/gtest.h>

#include <set>

#include "modeler/mesh/openmesh.h"
#include "modeler/mesh/simplify.h"
#include "modeler/mesh/validate.h"
#include "tests/mesh/mesh_bytes.h"
#include "tests/mesh/scenes.h"

namespace sgm::mesh {
namespace {

Mesh twoBalls(int resolution) {
    Scene s;
    const field::Owned parts[] = {{ball(s.graph, {-0.6f, 0, 0}, 1), 7}, {ball(s.graph, {0.6f, 0, 0}, 1), 3}};
    s.field = field::sum(s.graph, parts);
    return *meshOf(s, resolution).mesh;
}

void expectClosed(const Mesh& mesh) {
    EXPECT_EQ(measure(mesh).boundaryEdges, 0u);
    EXPECT_EQ(measure(mesh).nonmanifoldEdges, 0u);
}

std::multiset<OriginId> originsOf(const Mesh& mesh) {
    std::multiset<OriginId> all;
    for (const Chunk& c : mesh.chunks) all.insert(c.origins.begin(), c.origins.end());
    return all;
}

/// Mean squared distance of vertices from the centre of their neighbours, in m².
double roughness(const Mesh& mesh) {
    const HalfEdgeMesh half = toOpenMesh(mesh);
    double sum = 0;
    for (const OpenMesh::VertexHandle v : half.vertices()) {
        OpenMesh::Vec3f centre(0, 0, 0);
        for (const OpenMesh::VertexHandle u : half.vv_range(v)) centre += half.point(u);
        sum += (half.point(v) - centre / static_cast<float>(half.valence(v))).sqrnorm();
    }
    return sum / static_cast<double>(half.n_vertices());
}

TEST(OpenMesh, RoundTripKeepsEverything) {
    const Mesh mesh = twoBalls(40);
    const HalfEdgeMesh half = toOpenMesh(mesh);
    EXPECT_EQ(half.n_vertices(), mesh.vertexCount());
    EXPECT_EQ(half.n_faces(), mesh.triangleCount());
    const Mesh back = fromOpenMesh(half, true);
    ASSERT_EQ(back.chunks.size(), 1u);
    size_t v = 0, t = 0;
    for (const Chunk& c : mesh.chunks) {
        for (size_t i = 0; i < c.positions.size(); ++i, ++v) {
            ASSERT_EQ(back.chunks[0].positions[v], c.positions[i]);
            ASSERT_NEAR(length(back.chunks[0].normals[v] - c.normals[i]), 0, 1e-6);
        }
        for (size_t i = 0; i < c.triangles.size(); ++i, ++t) {
            ASSERT_EQ(back.chunks[0].origins[t], c.origins[i]);
            const Triangle a = back.chunks[0].triangles[t], b = c.inMesh(c.triangles[i]);
            ASSERT_TRUE(a == b || (a == Triangle{b.y, b.z, b.x}) || (a == Triangle{b.z, b.x, b.y}));
        }
    }
    EXPECT_GT(dot(fromOpenMesh(half, false).chunks[0].normals[100], mesh.chunks[0].normals[100]), 0.9f);
}

TEST(Edit, SmoothingEvensOutAndKeepsTheRest) {
    const Mesh mesh = twoBalls(40);
    const auto smoothed = smooth(mesh, 5, nullptr);
    ASSERT_TRUE(smoothed.ok());
    expectClosed(*smoothed);
    EXPECT_EQ(smoothed->triangleCount(), mesh.triangleCount());
    EXPECT_EQ(originsOf(*smoothed), originsOf(mesh));
    EXPECT_LT(roughness(*smoothed), 0.5 * roughness(mesh));
    EXPECT_NEAR(measure(*smoothed).volume_m3 / measure(mesh).volume_m3, 1, 0.02);
    EXPECT_EQ(bytesOf(*smooth(mesh, 0, nullptr)), bytesOf(mesh));
}

TEST(Edit, SimplifyingReachesItsRatioAndStaysClosed) {
    const Mesh mesh = twoBalls(60);
    const auto simple = simplifyToShare(mesh, 0.1, 2, nullptr);
    ASSERT_TRUE(simple.ok());
    expectClosed(*simple);
    const double share = static_cast<double>(simple->triangleCount()) / static_cast<double>(mesh.triangleCount());
    EXPECT_LE(share, 0.1);
    EXPECT_GT(share, 0.05);
    EXPECT_EQ(measure(*simple).euler, measure(mesh).euler);
    EXPECT_NEAR(measure(*simple).volume_m3 / measure(mesh).volume_m3, 1, 0.01);
    const std::multiset<OriginId> origins = originsOf(*simple);
    EXPECT_GT(origins.count(3), 50u);
    EXPECT_GT(origins.count(7), 50u);
    EXPECT_EQ(origins.count(3) + origins.count(7), origins.size());
    const auto judged = validate(*simple);
    ASSERT_TRUE(judged.ok());
    EXPECT_FALSE(judged->selfIntersects);
    EXPECT_EQ(simplifyToShare(mesh, 1, 1, nullptr)->triangleCount(), mesh.triangleCount());
}

/// Within so much, everything crosses everything.
TEST(Edit, ALargerToleranceLeavesNoMore) {
    const Mesh mesh = twoBalls(40);
    const auto fine = simplify(mesh, {.tolerance_m = 0.05}, nullptr),
               coarse = simplify(mesh, {.tolerance_m = 50}, nullptr);
    ASSERT_TRUE(fine.ok() && coarse.ok());
    EXPECT_LT(fine->triangleCount() * 5, mesh.triangleCount());
    EXPECT_LE(coarse->triangleCount(), fine->triangleCount());
    expectClosed(*coarse);
}

TEST(Edit, RefusesNonsenseAndStopsWhenAsked) {
    const Mesh mesh = twoBalls(30);
    EXPECT_EQ(simplifyToShare(mesh, 0, 1, nullptr).error().kind, Error::Kind::Usage);
    EXPECT_EQ(simplifyToShare(mesh, 1.5, 1, nullptr).error().kind, Error::Kind::Usage);
    EXPECT_EQ(smooth(mesh, -1, nullptr).error().kind, Error::Kind::Usage);
    Progress progress;
    progress.cancel();
    EXPECT_EQ(smooth(mesh, 3, &progress).error().kind, Error::Kind::Cancelled);
    EXPECT_EQ(simplifyToShare(mesh, 0.5, 1, &progress).error().kind, Error::Kind::Cancelled);
}

}  // namespace
}  // namespace sgm::mesh
