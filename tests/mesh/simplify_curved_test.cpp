// Decimation of curved regions.
#include <gtest/gtest.h>

#include "modeler/mesh/decimate.h"
#include "tests/mesh/gridded.h"
#include "tests/mesh/mesh_bytes.h"
#include "tests/mesh/scenes.h"
#include "tests/mesh/simplify_checks.h"

namespace sgm::mesh {
namespace {

/// One chunk, for checks that want it.
Mesh joined(const Mesh& mesh) {
    Mesh one;
    Chunk& all = one.chunks.emplace_back();
    for (const Chunk& c : mesh.chunks) {
        all.positions.insert(all.positions.end(), c.positions.begin(), c.positions.end());
        all.normals.insert(all.normals.end(), c.normals.begin(), c.normals.end());
        all.origins.insert(all.origins.end(), c.origins.begin(), c.origins.end());
        for (const Triangle& t : c.triangles) all.triangles.push_back(c.inMesh(t));
    }
    return one;
}

TEST(SimplifyCurved, NothingCurvedGoesWithoutATolerance) {
    const Mesh ball = sphere(16, 24);
    EXPECT_EQ(simplified(ball).triangleCount(), ball.triangleCount());
    const Mesh drum = cylinder(1, 2, 4, 40);
    // The caps of 40 corners, and the side as it was.
    EXPECT_EQ(simplified(drum).triangleCount(), 2u * 38 + 2u * 40 * 4);
}

TEST(SimplifyCurved, ACylinderIsAPrism) {
    for (const Placing& place : {Placing(asIs), turned(0.4), turned(2)}) {
        const double tolerance = 0.01;
        const Mesh drum = cylinder(1, 2, 12, 240, place), simple = simplified(drum, tolerance);
        expectSound(drum, simple, 0.02);
        expectWithin(drum, simple, tolerance);
        // A polygon whose chords are half the tolerance off its circle has 32 corners: 4 · 32 − 4 triangles.
        EXPECT_LT(simple.triangleCount(), 2u * 124);
    }
}

TEST(SimplifyCurved, ASphereStaysWithinTheTolerance) {
    const Mesh ball = sphere(48, 96);
    for (const double tolerance : {0.003, 0.02, 0.1}) {
        const Mesh simple = simplified(ball, tolerance);
        expectSound(ball, simple, 4 * tolerance);
        expectWithin(ball, simple, tolerance);
        EXPECT_LT(simple.triangleCount(), ball.triangleCount() / 3);
    }
}

TEST(SimplifyCurved, ARingWithoutBordersKeepsItsHole) {
    const Mesh torus = ring(1, 0.3, 40, 120), simple = simplified(torus, 0.01);
    expectSound(torus, simple, 0.05);
    expectWithin(torus, simple, 0.01);
    EXPECT_LT(simple.triangleCount(), torus.triangleCount() / 4);
}

TEST(SimplifyCurved, BordersOfCurvedRegionsStay) {
    const double tolerance = 0.01;
    const Mesh ball = sphere(60, 120, 4, 5), simple = simplified(ball, tolerance);  // labels part at y = −1/2
    expectSound(ball, simple, 0.03);
    expectWithin(ball, simple, tolerance);
    const Chunk& c = simple.chunks[0];
    double length_m = 0;
    for (size_t t = 0; t < c.triangles.size(); ++t)
        for (int i = 0; i < 3; ++i) {
            const uint32_t a = c.triangles[t][i], b = c.triangles[t][(i + 1) % 3];
            for (size_t u = 0; u < c.triangles.size(); ++u)
                for (int k = 0; k < 3; ++k)
                    if (c.labels[t] == 4 && c.labels[u] == 5 && c.triangles[u][k] == b &&
                        c.triangles[u][(k + 1) % 3] == a) {
                        length_m += static_cast<double>(length(c.positions[b] - c.positions[a]));
                        EXPECT_NEAR(c.positions[a].y, -0.5f, 1e-6f);
                    }
        }
    EXPECT_NEAR(length_m, 2 * std::numbers::pi * std::sqrt(0.75), 0.1);
    EXPECT_LT(simple.triangleCount(), ball.triangleCount() / 4);
}

TEST(SimplifyCurved, PlanarRingsKeepTheirHoles) {
    const Mesh tube = revolved(cutFinely({{1, 0, 1, 1}, {2, 0, 1, 2}, {2, 1, 1, 3}, {1, 1, 1, 4}}, 5, true), 160, true);
    const Mesh simple = simplified(tube, 0.01);
    expectSound(tube, simple, 0.02);
    expectWithin(tube, simple, 0.01);
    EXPECT_LT(simple.triangleCount(), 600u);
}

TEST(SimplifyCurved, AWallThinnerThanTheToleranceIsNotCrossed) {
    for (const double thickness : {0.002, 0.01, 0.03}) {
        SCOPED_TRACE(thickness);
        const Mesh shell = revolved(cutFinely({{0, 0, 1, 1},
                                               {1, 0, 1, 2},
                                               {1.2, 1, 1, 3},
                                               {1.2 - thickness, 1, 1, 4},
                                               {1 - thickness, thickness, 1, 5},
                                               {0, thickness, 1, 5}},
                                              8, false),
                                    90, false);
        const Mesh simple = simplified(shell, 0.02);
        expectSound(shell, simple, 1);
        expectWithin(shell, simple, 0.02);
        EXPECT_LT(simple.triangleCount(), shell.triangleCount());
    }
}

TEST(SimplifyCurved, MeshesWithoutLabelsAreDecimatedPartByPart) {
    const Scene scene = cloudScene(30, 0.2f, 9);
    const Mesh cloud = *meshOf(scene, 70).mesh, simple = simplified(cloud, 0.004);
    expectSound(cloud, simple, 0.05);
    expectWithin(joined(cloud), simple, 0.004);
    EXPECT_LT(3 * simple.triangleCount(), cloud.triangleCount());
    EXPECT_FALSE(simple.hasPositionsOnly());
    EXPECT_TRUE(simple.chunks[0].labels.empty());
}

TEST(SimplifyCurved, FractalsStaySound) {
    const Mesh rough = *meshOf(fractal(), 60).mesh, simple = simplified(rough, 0.01);
    expectSound(rough, simple, 0.1);
    EXPECT_LT(simple.triangleCount(), rough.triangleCount());
}

TEST(SimplifyCurved, TheResultIsTheSameAtAnyNumberOfThreads) {
    const Mesh cloud = *meshOf(cloudScene(30, 0.2f, 4), 90).mesh;
    EXPECT_EQ(bytesOf(simplified(cloud, 0.003, 1)), bytesOf(simplified(cloud, 0.003, 5)));
}

TEST(SimplifyCurved, DecimatingAgainIsAsDecimatingAllWithWhatIsKept) {
    const FlatMesh flat = flatten(*meshOf(fractal(), 90).mesh, 2);
    const auto regions = findRegions(flat, 2);
    ASSERT_TRUE(regions.ok());
    const Chains chains = findChains(*regions);
    const std::vector<Plane> planes(regions->count());
    const DecimationInput input{flat, *regions, chains, planes};
    const DecimationLimits limits{.surface_m = 0.002, .chain_m = 0.001};
    Decimation again(input, limits), anew(input, limits);
    again.run(2, nullptr);
    const size_t first = again.triangles.size();
    ASSERT_GT(first, 8000u * 3);  // several patches
    for (int round = 0; round < 2; ++round) {
        for (const size_t share : {5, 3}) again.keepAround(static_cast<uint32_t>(again.triangles.size() / share));
        again.run(1 + round, nullptr);
    }
    EXPECT_GT(again.triangles.size(), first);
    anew.kept = again.kept;
    anew.run(2, nullptr);
    ASSERT_EQ(again.triangles.size(), anew.triangles.size());
    for (size_t t = 0; t < anew.triangles.size(); ++t) {
        ASSERT_EQ(again.triangles[t].corners, anew.triangles[t].corners) << t;
        ASSERT_TRUE(
            std::ranges::equal(again.pointsOver(static_cast<uint32_t>(t)), anew.pointsOver(static_cast<uint32_t>(t))));
    }
    EXPECT_EQ(again.next, anew.next);
}

TEST(SimplifyCurved, NormalsOfSmoothRegionsStay) {
    const Mesh drum = cylinder(1, 2, 12, 240), simple = simplified(drum, 0.01);
    const Chunk& c = simple.chunks[0];
    for (uint32_t t = 0; t < c.triangles.size(); ++t)
        for (uint32_t i = 0; i < 3; ++i) {
            const uint32_t v = c.triangles[t][static_cast<int>(i)];
            Vec3f n = c.normals[v];
            for (const CornerNormal& corner : c.cornerNormals)
                if (corner.corner == 3 * t + i) n = corner.normal;
            const Vec3f p = c.positions[v];
            const Vec3f expected =
                c.labels[t] == 2 ? normalized(Vec3f{p.x, 0, p.z}) : Vec3f{0, c.labels[t] == 1 ? -1.0f : 1.0f, 0};
            EXPECT_GT(dot(n, expected), 0.999f);
        }
}

TEST(SimplifyCurved, RefusesNonsenseAndStopsWhenAsked) {
    const Mesh ball = sphere(16, 24);
    EXPECT_EQ(simplify(ball, SimplifyOptions{.tolerance_m = -1}, nullptr).error().kind, Error::Kind::Usage);
    Mesh open = cylinder(1, 2, 3, 8);
    open.chunks[0].triangles.pop_back(), open.chunks[0].origins.pop_back(), open.chunks[0].labels.pop_back();
    open.chunks[0].labels.back() = 9;
    EXPECT_EQ(simplify(open, SimplifyOptions{}, nullptr).error().kind, Error::Kind::Input);
    Progress progress;
    progress.cancel();
    EXPECT_EQ(simplify(ball, SimplifyOptions{.tolerance_m = 0.1}, &progress).error().kind, Error::Kind::Cancelled);
    EXPECT_EQ(simplified(Mesh{}).triangleCount(), 0u);
}

}  // namespace
}  // namespace sgm::mesh
