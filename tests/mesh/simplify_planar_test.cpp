// Merging of planar regions.
#include <gtest/gtest.h>

#include "modeler/mesh/triangulate.h"
#include "tests/mesh/gridded.h"
#include "tests/mesh/mesh_bytes.h"
#include "tests/mesh/simplify_checks.h"

namespace sgm::mesh {
namespace {

void expectCounts(const Mesh& mesh, size_t triangles, size_t vertices) {
    EXPECT_EQ(mesh.triangleCount(), triangles);
    EXPECT_EQ(mesh.vertexCount(), vertices);
}

const std::vector<Placing>& placings() {
    static const std::vector<Placing> all{asIs, turned(0.3), turned(std::numbers::pi / 4), turned(2.1), [](Vec3d p) {
                                              return Mat3::rotation({0, 1, 0}, std::numbers::pi / 4) * p;
                                          }};
    return all;
}

TEST(SimplifyPlanar, ACubeIsTwelveTriangles) {
    for (const Placing& place : placings()) {
        const Mesh cube = surfaceOf(block({1, 1, 1}), 17, place), simple = simplified(cube);
        expectCounts(simple, 12, 8);
        expectSound(cube, simple);
    }
}

TEST(SimplifyPlanar, TwoCubesOfTwoOriginsAreTwentyTriangles) {
    Voxels two = block({2, 1, 1});
    two.at({1, 0, 0}) = 2;
    for (const Placing& place : placings()) {
        const Mesh cubes = surfaceOf(two, 9, place), simple = simplified(cubes);
        expectCounts(simple, 20, 12);
        expectSound(cubes, simple);
        EXPECT_EQ(std::count(simple.chunks[0].origins.begin(), simple.chunks[0].origins.end(), 1u), 10);
    }
}

TEST(SimplifyPlanar, HolesAndTouchingLoopsStay) {
    Voxels ring = block({5, 5, 1});  // two holes that touch in a corner, were it not for the floor below
    for (const Vec3i p : {Vec3i{1, 1, 0}, {2, 2, 0}, {3, 1, 0}}) ring.at(p) = 0;
    Voxels tray{{5, 5, 2}};
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 5; ++x) tray.at({x, y, 0}) = 1, tray.at({x, y, 1}) = ring.at({x, y, 0});
    makeManifold(tray);
    for (const Placing& place : placings()) {
        const Mesh mesh = surfaceOf(tray, 4, place), simple = simplified(mesh);
        expectSound(mesh, simple);
        EXPECT_LT(simple.triangleCount(), 100u);
    }
}

TEST(SimplifyPlanar, ACheckerboardKeepsItsBorders) {
    Voxels board = block({8, 1, 8});
    for (int z = 0; z < 8; ++z)
        for (int x = 0; x < 8; ++x) board.at({x, 0, z}) = 1 + static_cast<OriginId>((x + z) % 2);
    for (const Placing& place : placings()) {
        const Mesh mesh = surfaceOf(board, 3, place), simple = simplified(mesh);
        expectSound(mesh, simple);
        expectCounts(simple, 2 * (2 * 64 + 4 * 8), 2 * 81);
    }
}

TEST(SimplifyPlanar, RandomVoxelsStaySound) {
    for (uint64_t key = 0; key < 60; ++key) {
        SCOPED_TRACE(key);
        const Voxels voxels = randomVoxels(3 + static_cast<int>(key % 5), 1 + static_cast<int>(key % 3),
                                           0.2 + 0.1 * static_cast<double>(key % 4), key);
        const Placing& place = placings()[key % placings().size()];
        const Mesh mesh = surfaceOf(voxels, 1 + static_cast<int>(key % 3), place);
        if (mesh.triangleCount() == 0) continue;
        const Mesh simple = simplified(mesh, key % 2 ? 0.0 : 0.01);
        expectSound(mesh, simple);
    }
}

TEST(SimplifyPlanar, ABumpKeepsNoMoreThanItsOwnTriangles) {
    for (const Placing& place : placings()) {
        const Mesh bumpy = surfaceOf(block({1, 1, 1}), 17, [&](Vec3d p) {
            const bool inside = p.x == 8.0 / 17 && p.y == 1, onEdge = p.x == 1 && p.z == 0 && p.y == 5.0 / 17;
            return place((inside && p.z == 4.0 / 17) || onEdge ? p * 1.01 : p);
        });
        const Mesh simple = simplified(bumpy);
        expectSound(bumpy, simple, 1e-6);
        EXPECT_LT(simple.triangleCount(), 60u);
    }
}

TEST(SimplifyPlanar, LowBumpsDontLiftThePlaneOfTheirRegion) {
    // Twelve times as high as a plane may be off: near enough to be asked where it is.
    const double tolerance = 0.004, bump = 12 * 0.25 * tolerance;
    for (const Placing& place : placings()) {
        const Mesh flat = surfaceOf(block({1, 1, 1}), 40, [&](Vec3d p) {
            const bool some = p.y == 1 && std::lround(p.x * 40) % 10 == 5 && std::lround(p.z * 40) % 10 == 5;
            return place(some ? p + Vec3d{0, bump, 0} : p);
        });
        const Mesh simple = simplified(flat, tolerance);
        expectSound(flat, simple, 1e-3);
        // Five sides, 16 bumps of six triangles, and a side with as many holes of six corners.
        EXPECT_EQ(simple.triangleCount(), 10u + 16 * 6 + (4 + 16 * 6 + 2 * 16 - 2));
    }
}

TEST(SimplifyPlanar, RandomBumpsStaySound) {
    for (uint64_t key = 0; key < 30; ++key) {
        SCOPED_TRACE(key);
        const Placing& place = placings()[key % placings().size()];
        const Mesh mesh = surfaceOf(randomVoxels(3, 2, 0.4, key), 12, [&](Vec3d p) {
            uint64_t at = combine(key, 7);
            for (int axis = 0; axis < 3; ++axis) at = combine(at, static_cast<uint64_t>(std::lround(p[axis] * 12)));
            const auto some = [&](uint64_t i) { return (uniform(combine(at, i)) - 0.5) * 0.05; };
            return place(uniform(at) < 0.005 ? p + Vec3d{some(1), some(2), some(3)} : p);
        });
        if (mesh.triangleCount() == 0) continue;
        const Mesh simple = simplified(mesh, key % 2 ? 0.0 : 0.002);
        expectSound(mesh, simple, key % 2 ? 1e-5 : 1e-2);
        EXPECT_LT(simple.triangleCount(), mesh.triangleCount() / 4);
    }
}

TEST(SimplifyPlanar, RegionsMayTouchInPoints) {
    for (uint64_t key = 0; key < 12; ++key) {
        SCOPED_TRACE(key);
        Voxels board = block({7, 1, 7});
        for (size_t i = 0; i < board.origins.size(); ++i) board.origins[i] = 1 + (combine(key, i) >> 7 & 1);
        const Mesh mesh = surfaceOf(board, 2, placings()[key % placings().size()]), simple = simplified(mesh);
        expectSound(mesh, simple);
        EXPECT_LT(simple.triangleCount(), mesh.triangleCount() / 2);
    }
}

TEST(SimplifyPlanar, ACirclePaintedOnAPlaneStaysWithinTheTolerance) {
    const double tolerance = 0.01;
    const Mesh mesh = revolved(
        cutFinely({{0, 0, 1, 1}, {1, 0, 2, 1}, {2, 0, 2, 2}, {2, 1, 2, 3}, {0, 1, 2, 3}}, 6, false), 300, false);
    const Mesh simple = simplified(mesh, tolerance);
    expectSound(mesh, simple, 0.01);
    const Chunk& c = simple.chunks[0];
    double painted = 0;
    for (size_t t = 0; t < c.triangles.size(); ++t) {
        const Vec3f p = c.positions[c.triangles[t].x];
        if (c.origins[t] == 1)
            painted += static_cast<double>(
                           length(cross(c.positions[c.triangles[t].y] - p, c.positions[c.triangles[t].z] - p))) /
                       2;
    }
    EXPECT_NEAR(painted, std::numbers::pi, 2 * std::numbers::pi * tolerance);
    EXPECT_LT(simple.triangleCount(), 500u);
}

TEST(SimplifyPlanar, BordersThatCollapseAreRefused) {
    std::vector<Vec3f> line, zigzag;
    std::vector<DirectedEdge> around;
    for (uint32_t i = 0; i < 40; ++i) {
        line.push_back({static_cast<float>(i < 20 ? i : 40 - i) * 0.25f + (i < 20 ? 0.0f : 0.1f), 0, 1});
        zigzag.push_back({static_cast<float>(i), static_cast<float>(i % 2), 0});
        around.push_back({i, (i + 1) % 40});
    }
    std::vector<Triangle> triangles;
    EXPECT_FALSE(triangulatePlanar(around, line, {0, 0, 1}, triangles)) << "all points on one line";
    around.assign(30, {3, 3});
    EXPECT_FALSE(triangulatePlanar(around, zigzag, {0, 0, 1}, triangles)) << "edges of no length";
    EXPECT_TRUE(triangles.empty());
}

TEST(SimplifyPlanar, TheResultIsTheSameAtAnyNumberOfThreads) {
    const Mesh mesh = surfaceOf(randomVoxels(8, 3, 0.4, 11), 3, turned(1));
    EXPECT_EQ(bytesOf(simplified(mesh, 0.01, 1)), bytesOf(simplified(mesh, 0.01, 4)));
}

TEST(SimplifyPlanar, NormalsAreThePlanes) {
    const Mesh simple = simplified(surfaceOf(block({2, 3, 1}), 5, turned(0.7)));
    const Chunk& c = simple.chunks[0];
    size_t own = 0;
    for (uint32_t t = 0; t < c.triangles.size(); ++t) {
        const Vec3f p = c.positions[c.triangles[t].x];
        const Vec3f face = normalized(cross(c.positions[c.triangles[t].y] - p, c.positions[c.triangles[t].z] - p));
        for (uint32_t i = 0; i < 3; ++i) {
            Vec3f n = c.normals[c.triangles[t][static_cast<int>(i)]];
            for (const CornerNormal& corner : c.cornerNormals)
                if (corner.corner == 3 * t + i) n = corner.normal, ++own;
            EXPECT_GT(dot(n, face), 0.99999f);
        }
    }
    EXPECT_EQ(own, c.cornerNormals.size());
}

}  // namespace
}  // namespace sgm::mesh
