// Figures and judgements on good meshes and on deliberately bad ones.
#include "modeler/mesh/validate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "modeler/core/conventions.h"
#include "tests/mesh/scenes.h"

namespace sgm::mesh {
namespace {

Mesh oneChunk(PageVector<Vec3f> positions, PageVector<Triangle> triangles) {
    Mesh mesh;
    Chunk c;
    c.normals.resize(positions.size(), Vec3f{0, 0, 1});
    c.origins.assign(triangles.size(), 0);
    c.positions = std::move(positions);
    c.triangles = std::move(triangles);
    mesh.chunks.push_back(std::move(c));
    return mesh;
}

/// A tetrahedron of volume 1/6 with its corner at `at`.
void addTetrahedron(PageVector<Vec3f>& p, PageVector<Triangle>& t, Vec3f at) {
    const auto v = static_cast<uint32_t>(p.size());
    p.insert(p.end(), {at, at + Vec3f{1, 0, 0}, at + Vec3f{0, 1, 0}, at + Vec3f{0, 0, 1}});
    t.insert(t.end(), {{v, v + 2, v + 1}, {v, v + 1, v + 3}, {v, v + 3, v + 2}, {v + 1, v + 2, v + 3}});
}

Mesh tetrahedra(std::initializer_list<Vec3f> places) {
    PageVector<Vec3f> p;
    PageVector<Triangle> t;
    for (const Vec3f at : places) addTetrahedron(p, t, at);
    return oneChunk(std::move(p), std::move(t));
}

TEST(Measure, TetrahedraHaveTheirClosedForms) {
    const MeshFigures f = measure(tetrahedra({{5, 5, 5}, {9, 0, 0}}));
    EXPECT_EQ(f.vertices, 8u);
    EXPECT_EQ(f.triangles, 8u);
    EXPECT_EQ(f.components, 2u);
    EXPECT_EQ(f.boundaryEdges, 0u);
    EXPECT_EQ(f.nonmanifoldEdges, 0u);
    EXPECT_EQ(f.euler, 4);
    EXPECT_NEAR(f.volume_m3, 2.0 / 6, 1e-12);
    EXPECT_NEAR(f.area_m2, 2 * (1.5 + std::sqrt(3.0) / 2), 1e-6);
    EXPECT_EQ(f.bounds, (Box3f{{5, 0, 0}, {10, 6, 6}}));
}

TEST(Measure, CavitiesAreComponentsTurnedInsideOut) {
    Mesh m = tetrahedra({{0, 0, 0}, {9, 0, 0}, {0, 9, 0}});
    EXPECT_EQ(measure(m).cavities, 0u);
    for (size_t t = 0; t < 4; ++t) std::swap(m.chunks[0].triangles[t].y, m.chunks[0].triangles[t].z);
    EXPECT_EQ(measure(m).components, 3u);
    EXPECT_EQ(measure(m).cavities, 1u);
    EXPECT_NEAR(measure(m).volume_m3, 1.0 / 6, 1e-12);
}

TEST(Measure, MissingTriangleLeavesThreeBoundaryEdges) {
    Mesh m = tetrahedra({{0, 0, 0}});
    m.chunks[0].triangles.pop_back();
    EXPECT_EQ(measure(m).boundaryEdges, 3u);
    EXPECT_EQ(measure(m).nonmanifoldEdges, 0u);
}

TEST(Measure, FlippedTriangleMakesItsEdgesNonManifold) {
    Mesh m = tetrahedra({{0, 0, 0}});
    std::swap(m.chunks[0].triangles[0].y, m.chunks[0].triangles[0].z);
    EXPECT_EQ(measure(m).nonmanifoldEdges, 3u);
}

TEST(Measure, WeldingJoinsWhatTouches) {
    // Two tetrahedra share an edge of equal positions: manifold apart, not once welded.
    const Mesh m = tetrahedra({{0, 0, 0}});
    Mesh two = m;
    Chunk mirrored = m.chunks[0];
    for (Vec3f& p : mirrored.positions) p = {-p.x, -p.y, p.z};
    mirrored.firstVertex = 4;
    two.chunks.push_back(mirrored);
    EXPECT_EQ(measure(two).nonmanifoldEdges, 0u);
    EXPECT_EQ(measure(two).components, 2u);
    const MeshFigures welded = measureWelded(two);
    EXPECT_EQ(welded.nonmanifoldEdges, 1u);
    EXPECT_EQ(welded.components, 1u);
    EXPECT_EQ(welded.vertices, 6u);
    EXPECT_NEAR(welded.volume_m3, 2.0 / 6, 1e-12);
}

TEST(Measure, EmptyMeshHasNothing) {
    const MeshFigures f = measure({});
    EXPECT_EQ(f.vertices, 0u);
    EXPECT_EQ(f.euler, 0);
    EXPECT_TRUE(f.bounds.empty());
}

TEST(Judge, AcceptsACloudWithHolesAndSeams) {
    // Cut, blended and unresolved: every ambiguous case turns up.
    Scene s = cloudScene(60, 0.12f, 21);
    s.field = field::difference({s.field, 0}, {ball(s.graph, {0.5f, 0.5f, 0.5f}, 0.35f), 99});
    const BuiltMesh m = meshOf(s, 60);
    const auto judged = validate(*m.mesh);
    ASSERT_TRUE(judged.ok());
    EXPECT_TRUE(judged->closed);
    EXPECT_TRUE(judged->outward);
    EXPECT_FALSE(judged->selfIntersects);
    EXPECT_NEAR(judged->volume_m3, measure(*m.mesh).volume_m3, 1e-6);
}

TEST(Judge, NoiseNeverCrossesItself) {
    Scene s;
    const field::Point p = s.graph.position();
    const field::NodeRef f =
        sin(p.x * 71.0f + p.y * 13.0f) + sin(p.y * 83.0f + p.z * 29.0f) + sin(p.z * 97.0f + p.x * 31.0f);
    const BuiltMesh m = meshOf(eval::compile(s.graph, {f, {{-1, -1, -1}, {1, 1, 1}}, 300, 0}, s.graph.constants()),
                               {{-1, -1, -1}, 0.1f, {20, 20, 20}});
    ASSERT_GT(m.mesh->triangleCount(), 5000u);
    const auto judged = validate(*m.mesh);
    ASSERT_TRUE(judged.ok());
    EXPECT_TRUE(judged->closed);
    EXPECT_FALSE(judged->selfIntersects);
}

TEST(Judge, VerticesWithoutTrianglesDontCount) {
    Mesh m = tetrahedra({{0, 0, 0}});
    m.chunks[0].positions.insert(m.chunks[0].positions.begin() + 2, Vec3f{7, 7, 7});
    m.chunks[0].normals.push_back({0, 0, 1});
    for (Triangle& t : m.chunks[0].triangles)
        for (int k = 0; k < 3; ++k) t[k] += t[k] >= 2 ? 1 : 0;
    const auto word = validate(m);
    ASSERT_TRUE(word.ok());
    EXPECT_TRUE(word->closed && word->outward && !word->selfIntersects);
}

TEST(Judge, SeesCrossingTetrahedra) {
    const auto apart = validate(tetrahedra({{0, 0, 0}, {2, 0, 0}}));
    ASSERT_TRUE(apart.ok());
    EXPECT_FALSE(apart->selfIntersects);
    EXPECT_TRUE(apart->outward);
    const auto crossing = validate(tetrahedra({{0, 0, 0}, {0.2f, 0.2f, 0.2f}}));
    ASSERT_TRUE(crossing.ok());
    EXPECT_TRUE(crossing->selfIntersects);
    EXPECT_TRUE(crossing->closed);
}

TEST(Judge, SeesInsideOutAndOpenMeshes) {
    Mesh inverted = tetrahedra({{0, 0, 0}});
    for (Triangle& t : inverted.chunks[0].triangles) std::swap(t.y, t.z);
    EXPECT_TRUE(validate(inverted)->closed);
    EXPECT_FALSE(validate(inverted)->outward);
    EXPECT_LT(validate(inverted)->volume_m3, 0);
    Mesh open = tetrahedra({{0, 0, 0}});
    open.chunks[0].triangles.pop_back();
    EXPECT_FALSE(validate(open)->closed);
}

TEST(Judge, RefusesMeshesThatAreNone) {
    Mesh dangling = tetrahedra({{0, 0, 0}});
    dangling.chunks[0].triangles[0].x = 17;
    EXPECT_EQ(validate(dangling).error().kind, Error::Kind::Input);
    Mesh nan = tetrahedra({{0, 0, 0}});
    nan.chunks[0].positions[0].x = NAN;
    EXPECT_FALSE(validate(nan).ok());
}

}  // namespace
}  // namespace sgm::mesh
