// Convex polyhedra: clipping, subtracting, joining, and the triangles they become.
#include "modeler/mesh/convex_polyhedron.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "modeler/core/conventions.h"

namespace sgm::mesh {
namespace {

const Box3d unit{{0, 0, 0}, {1, 1, 1}};

double volume_m3(const std::vector<ConvexPolyhedron>& pieces) {
    double sum = 0;
    for (const ConvexPolyhedron& piece : pieces) sum += piece.volume_m3();
    return sum;
}

field::ConvexPart boxAt(Vec3d centre, Vec3d half, const Mat3& axes = {}) {
    field::ConvexPart part = field::convex::cube(half, {}, field::convex::Roundness::Fine)[0];
    for (field::HalfSpace& plane : part) {
        plane.normal = axes * plane.normal;
        plane.offset += dot(plane.normal, centre);
    }
    return part;
}

/// Every edge is run through once each way.
void expectClosed(const ConvexPolyhedron& piece) {
    std::vector<Vec3f> positions;
    std::vector<Triangle> triangles;
    piece.triangulate(positions, triangles);
    std::map<std::pair<uint32_t, uint32_t>, int> runs;
    double six = 0;
    for (const Triangle& t : triangles) {
        for (int i = 0; i < 3; ++i) ++runs[{t[i], t[(i + 1) % 3]}];
        six += static_cast<double>(dot(positions[t.x], cross(positions[t.y], positions[t.z])));
    }
    for (const auto& [edge, count] : runs) {
        EXPECT_EQ(count, 1);
        EXPECT_EQ(runs.count({edge.second, edge.first}), 1u);
    }
    EXPECT_NEAR(six / 6, piece.volume_m3(), 1e-5 * piece.volume_m3()) << "outward";
}

TEST(ConvexPolyhedron, ACornerIsCutOff) {
    const ConvexPolyhedron cube(unit);
    EXPECT_EQ(cube.faces().size(), 6u);
    EXPECT_DOUBLE_EQ(cube.volume_m3(), 1);
    expectClosed(cube);
    const double third = 1 / std::sqrt(3.0);
    const auto cut = cube.clipped({{third, third, third}, 2.5 * third});
    ASSERT_TRUE(cut);
    EXPECT_EQ(cut->faces().size(), 7u);
    EXPECT_NEAR(cut->volume_m3(), 1 - 0.125 / 6, 1e-12);
    expectClosed(*cut);
    EXPECT_FALSE(cube.clipped({{1, 0, 0}, 0}));
    EXPECT_FALSE(cube.clipped({{1, 0, 0}, 5e-4})) << "thinner than a millimetre";
    EXPECT_NEAR(cube.clipped({{1, 0, 0}, 2})->volume_m3(), 1, 1e-12);
}

TEST(ConvexPolyhedron, WhatIsSubtractedIsMissingWhateverItsTurn) {
    const ConvexPolyhedron cube(unit);
    for (int step = 0; step < 12; ++step) {
        const Mat3 axes = Mat3::rotation({1, 2, 3}, step * 0.27);
        const field::ConvexPart part = boxAt({0.5, 0.5, 0.5}, {0.2, 0.15, 0.1}, axes);
        const auto pieces = subtracted(cube, part);
        EXPECT_EQ(pieces.size(), 6u);
        EXPECT_NEAR(volume_m3(pieces), 1 - 0.4 * 0.3 * 0.2, 1e-9);
        for (const ConvexPolyhedron& piece : pieces) expectClosed(piece);
    }
    EXPECT_EQ(subtracted(cube, boxAt({2, 0.5, 0.5}, {0.5, 1, 1})).size(), 1u) << "only touches";
    EXPECT_EQ(subtracted(cube, boxAt({1.2, 1.2, 0.5}, {0.3, 0.3, 1}, Mat3::rotation({0, 0, 1}, pi / 4))).size(), 1u)
        << "within its box, beyond its planes";
    EXPECT_TRUE(subtracted(cube, boxAt({0.5, 0.5, 0.5}, {1, 1, 1})).empty());
}

TEST(ConvexPolyhedron, PiecesJoinWhereTheyAreConvexTogether) {
    std::vector<ConvexPolyhedron> pieces;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 3; ++j) pieces.emplace_back(Box3d{{1.0 * i, 1.0 * j, 0}, {i + 1.0, j + 1.0, 1}});
    joinConvex(pieces);
    ASSERT_EQ(pieces.size(), 1u);
    EXPECT_NEAR(pieces[0].volume_m3(), 12, 1e-9);
    EXPECT_EQ(pieces[0].faces().size(), 6u);
    // An L stays two.
    std::vector<ConvexPolyhedron> corner{ConvexPolyhedron(unit), ConvexPolyhedron(Box3d{{1, 0, 0}, {2, 2, 1}})};
    joinConvex(corner);
    EXPECT_EQ(corner.size(), 2u);
    // What a wedge was cut from joins again.
    const auto cut = subtracted(ConvexPolyhedron(unit), {{normalized(Vec3d{1, 1, 0}), 1 / std::sqrt(2.0)}});
    ASSERT_EQ(cut.size(), 1u);
    std::vector<ConvexPolyhedron> halves{
        cut[0], *ConvexPolyhedron(unit).clipped({normalized(Vec3d{1, 1, 0}), 1 / std::sqrt(2.0)})};
    joinConvex(halves);
    ASSERT_EQ(halves.size(), 1u);
    EXPECT_NEAR(halves[0].volume_m3(), 1, 1e-9);
}

}  // namespace
}  // namespace sgm::mesh
