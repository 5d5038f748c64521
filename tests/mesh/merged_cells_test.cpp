// Flat cells as fans and cells along straight creases as strips: the surface stays the same.
#include <gtest/gtest.h>

#include "modeler/mesh/simplify.h"
#include "modeler/mesh/validate.h"
#include "tests/mesh/blocks.h"
#include "tests/mesh/mesh_bytes.h"
#include "tests/mesh/scenes.h"

namespace sgm::mesh {
namespace {

const PolygonizeOptions whole{.surface = Surface::Crisp}, merging{.surface = Surface::Crisp, .mergesCells = true};

Mesh meshed(const Scene& scene, int resolution, const PolygonizeOptions& options) {
    const BuiltMesh m = meshOf(scene, resolution, 2, options);
    EXPECT_TRUE(m.mesh.ok());
    const MeshFigures f = measure(*m.mesh);
    EXPECT_EQ(f.boundaryEdges, 0u) << resolution;
    EXPECT_EQ(f.nonmanifoldEdges, 0u) << resolution;
    const auto word = validate(*m.mesh);
    EXPECT_TRUE(word.ok() && word->closed && word->outward && !word->selfIntersects) << resolution;
    return *m.mesh;
}

size_t trianglesOfSimplified(const Scene& scene, int resolution, const Mesh& mesh) {
    const auto simple = simplify(mesh, {0.03 * double{cellFor(scene.field.bounds, resolution)}, 2}, nullptr);
    EXPECT_TRUE(simple.ok());
    return simple->triangleCount();
}

/// A block on a larger one, with a board around its foot and a window in it.
Scene tower() {
    Scene s;
    s.field =
        field::sum(s.graph, std::vector<field::Owned>{{block(s.graph, {}, {2.03f, .31f, 1.97f}), 1},
                                                      {block(s.graph, {.01f, 1.3f, .02f}, {1.01f, 1.13f, 1.21f}), 2},
                                                      {block(s.graph, {.01f, .45f, .02f}, {1.12f, .17f, 1.33f}), 3}});
    s.field = field::difference({s.field, 0}, {block(s.graph, {1.02f, 1.51f, .31f}, {.23f, .43f, .37f}), 4});
    return s;
}

TEST(MergedCells, TakeAFractionOfTheTrianglesAndAreTheSameSurface) {
    const Scene scene = tower();
    for (const int resolution : {20, 50, 128}) {
        const Mesh plain = meshed(scene, resolution, whole), merged = meshed(scene, resolution, merging);
        EXPECT_LT(merged.triangleCount(), plain.triangleCount() * (resolution < 40 ? 0.7 : 0.4)) << resolution;
        EXPECT_NEAR(measure(merged).volume_m3 / measure(plain).volume_m3, 1, 1e-6) << resolution;
        EXPECT_EQ(trianglesOfSimplified(scene, resolution, merged), trianglesOfSimplified(scene, resolution, plain))
            << resolution;
    }
}

TEST(MergedCells, OfRoundPartsAreThoseOfCellsThatStay) {
    const Scene scene = ballScene();
    EXPECT_EQ(bytesOf(*meshOf(scene, 60, 2, merging).mesh), bytesOf(*meshOf(scene, 60, 2, whole).mesh));
}

TEST(MergedCells, OfRandomBoxesAreTheSameSurface) {
    size_t plainTriangles = 0, mergedTriangles = 0;
    for (uint64_t key = 0; key < 60; ++key) {
        Scene s;
        std::vector<field::Owned> parts;
        uint64_t draw = mix(key + 5);
        const auto real = [&](double lo, double hi) { return static_cast<float>(uniform(draw = mix(draw), lo, hi)); };
        for (size_t i = 0; i < 2 + key % 5; ++i) {
            const Vec3f centre{real(-1, 1), real(-1, 1), real(-1, 1)}, half{real(.1, .8), real(.1, .8), real(.1, .8)};
            parts.push_back({block(s.graph, centre, half, i % 3 == 2 ? real(0, 90) : 0), static_cast<OriginId>(i + 1)});
        }
        s.field = field::sum(s.graph, parts);
        if (key % 3 == 0)
            s.field = field::difference({s.field, 0}, {block(s.graph, {real(-1, 1), 0, 0}, {.5f, .4f, .3f}), 99});
        const Mesh plain = meshed(s, 40, whole), merged = meshed(s, 40, merging);
        EXPECT_NEAR(measure(merged).volume_m3 / measure(plain).volume_m3, 1, 2e-5) << key;
        plainTriangles += trianglesOfSimplified(s, 40, plain);
        mergedTriangles += trianglesOfSimplified(s, 40, merged);
    }
    EXPECT_NEAR(double(mergedTriangles) / double(plainTriangles), 1, 0.01);
}

/// A crease along which a third part ends: the run there isn't alike from end to end.
TEST(MergedCells, KeepWhatEndsAlongACrease) {
    for (const float end : {-.41f, -.13f, .22f}) {
        Scene s;
        s.field =
            field::sum(s.graph, std::vector<field::Owned>{{block(s.graph, {}, {2, .5f, .5f}), 1},
                                                          {block(s.graph, {end - 1, .5f, .5f}, {1, .03f, .02f}), 2}});
        const Mesh plain = meshed(s, 64, whole), merged = meshed(s, 64, merging);
        EXPECT_NEAR(measure(merged).volume_m3 / measure(plain).volume_m3, 1, 1e-6) << end;
    }
}

TEST(MergedCells, AreTheSameOnAnyNumberOfThreads) {
    const Scene scene = tower();
    EXPECT_EQ(bytesOf(*meshOf(scene, 100, 1, merging).mesh), bytesOf(*meshOf(scene, 100, 3, merging).mesh));
}

}  // namespace
}  // namespace sgm::mesh
