// What FaultFinder finds: crossings, edges that are there twice, fans that meet in a vertex.
#include "modeler/mesh/faults.h"

#include <gtest/gtest.h>

namespace sgm::mesh {
namespace {

/// A tetrahedron over four vertices, seen from outside where d is above a, b, c.
void addTetrahedron(std::vector<SimpleTriangle>& to, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    for (const Triangle t : {Triangle{a, c, b}, Triangle{a, b, d}, Triangle{b, c, d}, Triangle{c, a, d}})
        to.push_back({t, 0});
}

std::vector<uint32_t> faultsOf(const std::vector<Vec3f>& positions, const std::vector<SimpleTriangle>& triangles) {
    return FaultFinder(positions, 2, nullptr).find(triangles);
}

const std::vector<Vec3f> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                                 {3, 0, 2}, {4, 0, 2}, {3, 1, 2}, {3, 0, 3}};
const std::vector<uint32_t> all{0, 1, 2, 3, 4, 5, 6, 7};

TEST(Faults, TwoTetrahedraApartHaveNone) {
    std::vector<SimpleTriangle> triangles;
    addTetrahedron(triangles, 0, 1, 2, 3), addTetrahedron(triangles, 4, 5, 6, 7);
    EXPECT_TRUE(faultsOf(corners, triangles).empty());
}

TEST(Faults, FansThatMeetInAVertexAre) {
    std::vector<SimpleTriangle> triangles;
    addTetrahedron(triangles, 0, 1, 2, 3), addTetrahedron(triangles, 3, 5, 6, 7);
    // The two faces that don't touch the vertex are sound.
    EXPECT_EQ(faultsOf(corners, triangles), (std::vector<uint32_t>{1, 2, 3, 4, 5, 7}));
}

TEST(Faults, CrossingsAre) {
    std::vector<Vec3f> moved = corners;
    for (size_t i = 4; i < 8; ++i) moved[i] -= Vec3f{2.9f, -0.1f, 1.9f};
    std::vector<SimpleTriangle> triangles;
    addTetrahedron(triangles, 0, 1, 2, 3), addTetrahedron(triangles, 4, 5, 6, 7);
    EXPECT_FALSE(faultsOf(moved, triangles).empty());
}

TEST(Faults, CrossingsWithinASoundRegionAreNotLookedFor) {
    std::vector<Vec3f> moved = corners;
    for (size_t i = 4; i < 8; ++i) moved[i] -= Vec3f{2.9f, -0.1f, 1.9f};
    std::vector<SimpleTriangle> triangles;
    addTetrahedron(triangles, 0, 1, 2, 3), addTetrahedron(triangles, 4, 5, 6, 7);
    const std::vector<uint8_t> sound{1, 1}, mixed{0, 1};
    const auto found = [&](std::span<const uint8_t> soundRegions) {
        return FaultFinder(moved, 2, nullptr).find(triangles, soundRegions);
    };
    EXPECT_TRUE(found(sound).empty());
    EXPECT_EQ(found(mixed), faultsOf(moved, triangles));
    for (size_t t = 4; t < 8; ++t) triangles[t].region = 1;  // two sound regions may cross each other
    EXPECT_EQ(found(sound), faultsOf(moved, triangles));
    EXPECT_FALSE(found(sound).empty());
}

TEST(Faults, EdgesThatAreThereTwiceAre) {
    std::vector<SimpleTriangle> triangles;
    addTetrahedron(triangles, 0, 1, 2, 3), addTetrahedron(triangles, 0, 1, 2, 7);
    const auto faults = faultsOf(corners, triangles);
    EXPECT_TRUE(std::find(faults.begin(), faults.end(), 0u) != faults.end());
}

TEST(Faults, OfASurfaceThatWasComparedBeforeAreThoseOfOneThatWasNot) {
    std::vector<Vec3f> positions = corners;
    for (const Vec3f p : corners) positions.push_back(p + Vec3f{0, 0, 10});
    std::vector<SimpleTriangle> sound, crossing, doubled;
    addTetrahedron(sound, 0, 1, 2, 3), addTetrahedron(sound, 4, 5, 6, 7);
    addTetrahedron(crossing, 0, 1, 2, 3), addTetrahedron(crossing, 4, 5, 6, 2);
    FaultFinder finder(positions, 2, nullptr);
    EXPECT_EQ(finder.find(crossing), faultsOf(positions, crossing));
    ASSERT_FALSE(faultsOf(positions, crossing).empty());
    EXPECT_EQ(finder.find(crossing), faultsOf(positions, crossing));  // faults stay faults
    EXPECT_TRUE(finder.find(sound).empty());
    addTetrahedron(doubled, 0, 1, 2, 3), addTetrahedron(doubled, 8, 9, 10, 3);  // touch in a vertex and cross
    EXPECT_EQ(finder.find(doubled), faultsOf(positions, doubled));
    ASSERT_FALSE(faultsOf(positions, doubled).empty());
}

}  // namespace
}  // namespace sgm::mesh
