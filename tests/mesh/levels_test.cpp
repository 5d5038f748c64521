// Levels of detail: coarser from one to the next, within what they promise.
#include "modeler/mesh/levels.h"

#include <gtest/gtest.h>

#include "modeler/mesh/corners.h"
#include "tests/mesh/gridded.h"
#include "tests/mesh/mesh_bytes.h"
#include "tests/mesh/simplify_checks.h"

namespace sgm::mesh {
namespace {

std::vector<LevelOfDetail> levelsOf(const Mesh& mesh, const LevelOptions& options) {
    auto made = makeLevels(mesh, options, nullptr);
    EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().message);
    return made.ok() ? std::move(*made) : std::vector<LevelOfDetail>();
}

TEST(Levels, TolerancesDoubleAndAreAPixelOfTheirPicture) {
    for (int level = 1; level < mostLevels; ++level) {
        EXPECT_EQ(levelCoverage(level), 1.0 / (1 << level));
        EXPECT_DOUBLE_EQ(levelTolerance(30, level + 1), 2 * levelTolerance(30, level));
        // The model's longest side takes coverage · 1080 lines.
        EXPECT_NEAR(levelTolerance(30, level) / 30 * levelCoverage(level) * 1080, 1, 1e-12);
    }
}

TEST(Levels, EachHasFewerTrianglesWithinItsTolerance) {
    const Mesh ball = sphere(48, 80);
    const auto levels = levelsOf(ball, {.count = 4});
    ASSERT_EQ(levels.size(), 4u);
    size_t before = ball.triangleCount();
    for (const LevelOfDetail& level : levels) {
        EXPECT_LT(level.mesh.triangleCount(), before);
        before = level.mesh.triangleCount();
        expectSound(ball, level.mesh, 0.2);
        expectWithin(ball, level.mesh, level.tolerance_m);
        EXPECT_EQ(level.cell_m, 0);
    }
    EXPECT_LT(before, ball.triangleCount() / 8);
    EXPECT_EQ(levels[1].tolerance_m, levelTolerance(static_cast<double>(maxComponent(ball.bounds().size())), 2));
    EXPECT_EQ(levels[1].coverage, 0.25);
}

TEST(Levels, AreTheSameAtAnyNumberOfThreads) {
    const Mesh ball = sphere(48, 80);
    const auto one = levelsOf(ball, {.count = 3, .threads = 1}), four = levelsOf(ball, {.count = 3, .threads = 4});
    for (size_t i = 0; i < one.size(); ++i) EXPECT_EQ(bytesOf(one[i].mesh), bytesOf(four[i].mesh));
}

TEST(Levels, WhatSimplificationKeepsGoesWhereTheFieldIsMeshedAnew) {
    // A ball of a thousand parts, each of which simplification keeps, and the same ball as one part.
    Mesh parts = sphere(48, 80);
    const Mesh whole = sphere(24, 40);
    for (Chunk& c : parts.chunks)
        for (size_t t = 0; t < c.origins.size(); ++t) c.origins[t] = static_cast<OriginId>(t / 8);
    std::vector<float> cells;
    LevelOptions options{.count = 4, .cell_m = 0.01f, .meshAt = [&](float cell_m) -> Result<Mesh> {
                             cells.push_back(cell_m);
                             return whole;
                         }};
    const double side_m = static_cast<double>(maxComponent(parts.bounds().size()));
    const auto levels = levelsOf(parts, options);
    ASSERT_EQ(levels.size(), 4u);
    // Cells of twice the tolerance, from the first that are larger than the finest mesh's.
    std::vector<float> wanted;
    for (int level = 1; level <= 4; ++level)
        if (2 * levelTolerance(side_m, level) > 0.01)
            wanted.push_back(static_cast<float>(2 * levelTolerance(side_m, level)));
    EXPECT_EQ(cells, wanted);
    EXPECT_LT(wanted.size(), 4u);
    EXPECT_EQ(levels[3].cell_m, wanted.back());
    EXPECT_LE(levels[3].mesh.triangleCount(), whole.triangleCount());
    EXPECT_LT(levels[3].mesh.triangleCount(), levelsOf(parts, {.count = 4})[3].mesh.triangleCount() / 2);
}

/// The least cosine between a corner's normal and its triangle.
float leastCosine(const Mesh& mesh) {
    const std::vector<Triangle> triangles = gatherTriangles(mesh);
    const CornerNormalTable own = collectCornerNormals(mesh);
    const Chunk& c = mesh.chunks[0];
    float least = 1;
    for (size_t t = 0; t < triangles.size(); ++t) {
        const Vec3f a = c.positions[triangles[t].x], b = c.positions[triangles[t].y], d = c.positions[triangles[t].z];
        const Vec3f face = normalized(cross(b - a, d - a));
        for (int k = 0; k < 3; ++k) {
            const uint32_t number = own.empty() ? noIndex : own.of[t][k];
            least = std::min(least, dot(face, number == noIndex ? c.normals[triangles[t][k]] : own.normals[number]));
        }
    }
    return least;
}

/// A drum with corners along the upper rim, of its wall, whose normals look down as those of a sliver below eaves do:
/// one of three at each vertex, or all.
Mesh drumWithOddCorners(bool isAll) {
    Mesh drum = cylinder(1, 2, 12, 240);
    Chunk& chunk = drum.chunks[0];
    std::vector<uint8_t> seen(chunk.positions.size());
    std::vector<CornerNormal> odd = chunk.cornerNormals;
    for (uint32_t corner = 0; corner < 3 * chunk.triangles.size(); ++corner) {
        const uint32_t v = chunk.triangles[corner / 3][static_cast<int>(corner % 3)];
        if (chunk.labels[corner / 3] != 2 || chunk.positions[v].y < 2 || (seen[v] && !isAll)) continue;
        seen[v] = 1;
        odd.push_back({corner, {0, -1, 0}});
    }
    EXPECT_EQ(odd.size(), chunk.cornerNormals.size() + (isAll ? 720 : 240));
    std::sort(odd.begin(), odd.end(), [](const auto& a, const auto& b) { return a.corner < b.corner; });
    chunk.cornerNormals = odd;
    return drum;
}

TEST(Levels, NormalsAreThoseOfTheFacesAround) {
    for (const bool isAll : {false, true}) {
        const Mesh drum = drumWithOddCorners(isAll);
        for (const LevelOfDetail& level : levelsOf(drum, {.count = 4})) {
            EXPECT_LT(level.mesh.triangleCount(), drum.triangleCount() / 2);
            EXPECT_GT(leastCosine(level.mesh), 0.5f) << isAll;
        }
    }
}

TEST(Levels, AnErrorOfTheMesherIsHandedOn) {
    LevelOptions options{.count = 2, .meshAt = [](float) -> Result<Mesh> { return cancelledError(); }};
    const auto made = makeLevels(sphere(12, 20), options, nullptr);
    ASSERT_FALSE(made.ok());
    EXPECT_EQ(made.error().kind, Error::Kind::Cancelled);
}

}  // namespace
}  // namespace sgm::mesh
