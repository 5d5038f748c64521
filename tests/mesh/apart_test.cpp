// Components that are apart from one another, split off and simplified each by itself.
#include "modeler/mesh/apart.h"

#include <gtest/gtest.h>

#include "tests/mesh/gridded.h"
#include "tests/mesh/mesh_bytes.h"
#include "tests/mesh/simplify_checks.h"

namespace sgm::mesh {
namespace {

/// One mesh of balls at some places, a chunk each.
Mesh balls(const std::vector<Vec3d>& places) {
    Mesh mesh;
    for (const Vec3d& place : places) {
        Chunk chunk = sphere(24, 48).chunks[0];
        for (Vec3f& p : chunk.positions) p += place.as<float>();
        chunk.firstVertex = static_cast<uint32_t>(mesh.vertexCount());
        mesh.chunks.push_back(std::move(chunk));
    }
    return mesh;
}

TEST(Apart, ComponentsStayTogetherWhereTheirBoxesDo) {
    EXPECT_TRUE(splitApart(balls({{0, 0, 0}}), 0.1, 1).empty());
    EXPECT_TRUE(splitApart(balls({{0, 0, 0}, {2.05, 0, 0}}), 0.1, 1).empty()) << "nearer than the reach";
    const std::vector<Mesh> two = splitApart(balls({{0, 0, 0}, {2.2, 0, 0}}), 0.1, 1);
    ASSERT_EQ(two.size(), 2u);
    EXPECT_EQ(two[0].triangleCount(), two[1].triangleCount());
    const std::vector<Mesh> chain = splitApart(balls({{0, 0, 0}, {9, 0, 0}, {1.5, 0, 0}}), 0.1, 1);
    ASSERT_EQ(chain.size(), 2u);
    EXPECT_EQ(chain[0].triangleCount(), 2 * chain[1].triangleCount());
}

TEST(Apart, TakesWhatItMovesToIntoAccount) {
    Mesh two = balls({{0, 0, 0}, {2.2, 0, 0}});
    two.chunks[0].confined.push_back({0, {1.15f, 0, 0}});
    EXPECT_TRUE(splitApart(two, 0.1, 1).empty());
}

TEST(Apart, JoinedAgainAllIsThere) {
    const Mesh mesh = balls({{0, 0, 0}, {3, 0, 0}, {0, 5, 0}});
    const std::vector<Mesh> pieces = splitApart(mesh, 0.1, 2);
    ASSERT_EQ(pieces.size(), 3u);
    const Mesh joined = join({&pieces[0], &pieces[1], &pieces[2]});
    const MeshFigures is = measure(joined), was = measure(mesh);
    EXPECT_EQ(is.triangles, was.triangles);
    EXPECT_EQ(is.boundaryEdges, 0u);
    EXPECT_EQ(is.components, 3u);
    EXPECT_NEAR(is.volume_m3, was.volume_m3, 1e-9);
}

TEST(Apart, APieceIsSimplifiedAsItIsAlone) {
    const double tolerance = 0.02;
    const Mesh simple = simplified(balls({{0, 0, 0}, {3, 0, 0}}), tolerance);
    expectSound(balls({{0, 0, 0}, {3, 0, 0}}), simple, 0.1);
    EXPECT_EQ(simple.triangleCount(), simplified(balls({{0, 0, 0}}), tolerance).triangleCount() +
                                          simplified(balls({{3, 0, 0}}), tolerance).triangleCount());
}

TEST(Apart, PiecesOfTheCallBeforeGiveTheSameBytes) {
    SimplifiedPieces pieces;
    for (const double place : {3.0, 3.0, 4.0, 3.5}) {
        const Mesh mesh = balls({{0, 0, 0}, {0, place, 0}, {place, 0, 0}});
        const auto kept = simplify(mesh, {.tolerance_m = 0.02, .threads = 2, .pieces = &pieces}, nullptr);
        ASSERT_TRUE(kept.ok());
        EXPECT_EQ(bytesOf(*kept), bytesOf(simplified(mesh, 0.02, 1))) << place;
    }
    const Mesh mesh = balls({{0, 0, 0}, {3, 0, 0}});
    const auto finer = simplify(mesh, {.tolerance_m = 0.001, .pieces = &pieces}, nullptr);
    ASSERT_TRUE(finer.ok());
    EXPECT_EQ(bytesOf(*finer), bytesOf(simplified(mesh, 0.001))) << "what was made to another tolerance goes";
}

/// Six times the volume under triangles near the origin.
double sixfoldNearOrigin(const Mesh& mesh) {
    double sum = 0;
    for (const Chunk& c : mesh.chunks)
        for (const Triangle& t : c.triangles) {
            const Vec3d a = c.positions[t.x].as<double>(), b = c.positions[t.y].as<double>();
            if (length(a) < 0.5) sum += dot(a, cross(b, c.positions[t.z].as<double>()));
        }
    return sum;
}

TEST(Simplify, TurnsNothingInsideOut) {
    for (const double tolerance : {0.02, 0.05, 0.1, 0.2})
        for (const float size : {0.01f, 0.04f, 0.1f}) {
            Mesh mesh = balls({{0, 0, 0}});
            Chunk cavity = sphere(8, 12).chunks[0];
            for (Vec3f& p : cavity.positions) p *= size;
            for (Triangle& t : cavity.triangles) std::swap(t.y, t.z);
            for (Vec3f& n : cavity.normals) n *= -1.0f;
            cavity.firstVertex = static_cast<uint32_t>(mesh.vertexCount());
            mesh.chunks.push_back(std::move(cavity));
            EXPECT_LT(sixfoldNearOrigin(simplified(mesh, tolerance)), 0) << tolerance << ' ' << size;
        }
}

}  // namespace
}  // namespace sgm::mesh
