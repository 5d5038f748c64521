// What floats is taken out of a level set, closed cavities are filled; the rest keeps its distances.
#include "modeler/volume/keep.h"

#include <gtest/gtest.h>

#include "modeler/mesh/polygonize.h"
#include "modeler/mesh/validate.h"
#include "tests/volume/shapes.h"

namespace sgm::volume {
namespace {

/// A ball that stands, with a hollow in it; a smaller one that hangs above, debris, and a third on the ground.
struct Four {
    KnownSolid solid;
    field::NodeRef stands, hollow, hangs, crumb, third;
    Four() {
        field::Graph& g = *solid.graph;
        stands = ball(g, {0, 0, 0}, 1), hollow = ball(g, {0.1f, 0, 0}, 0.4f), hangs = ball(g, {0, 1.8f, 0.1f}, 0.5f);
        crumb = ball(g, {1.6f, -0.95f, 0}, 0.06f), third = ball(g, {-1.7f, -0.5f, 0}, 0.5f);
        solid.field.value = min(min(max(stands, -hollow), hangs), min(crumb, third));
        solid.field.bounds = {{-2.2f, -1.01f, -1}, {1.7f, 2.3f, 1}};
    }
    /// Of a ball of that radius.
    static double volume(double r) { return 4 * pi / 3 * r * r * r; }
};

TEST(Keep, TakesOutWhatFloatsAndFillsWhatIsClosed) {
    const Four four;
    const auto kept = [&](mesh::Keep keep) {
        Volume level = *levelSetOf(four.solid, 0.03f);
        EXPECT_TRUE(keepOnly(level, keep, level.voxel_m(), nullptr).ok());
        return level;
    };
    const Volume all = kept(mesh::Keep::All), grounded = kept(mesh::Keep::Grounded),
                 largest = kept(mesh::Keep::Largest);
    EXPECT_NEAR(all.enclosed_m3(), Four::volume(1) - Four::volume(0.4) + 2 * Four::volume(0.5), 0.02);
    EXPECT_NEAR(grounded.enclosed_m3(), Four::volume(1) + Four::volume(0.5), 0.02);
    EXPECT_NEAR(largest.enclosed_m3(), Four::volume(1), 0.02);
    EXPECT_FLOAT_EQ(grounded.at({0, 1.8f, 0.1f}), 3 * grounded.voxel_m()) << "clear air";
    EXPECT_FLOAT_EQ(grounded.at({0.1f, 0, 0}), -3 * grounded.voxel_m()) << "deep inside";
    EXPECT_EQ(mesh::measure(*toMesh(all)).components, 5u);
    EXPECT_EQ(mesh::measure(*toMesh(grounded)).components, 2u);
    EXPECT_EQ(mesh::measure(*toMesh(largest)).components, 1u);
    for (const Vec3f p : {Vec3f{0.95f, 0.1f, 0}, Vec3f{0, -0.98f, 0.05f}, Vec3f{0.6f, 0.6f, 0.55f}})
        EXPECT_EQ(largest.at(p), all.at(p));
}

/// Voxels and mesh judge alike, at the surface of the very same solids.
TEST(Keep, AgreesWithTheMesh) {
    const Four four;
    const eval::Tape tape = four.solid.tape();
    const mesh::Grid grid = mesh::gridFor(four.solid.field.bounds, 0.04f);
    mesh::Counts counts;
    const auto blocks = mesh::subdivide(tape, grid, 2, nullptr, counts);
    for (const mesh::Keep keep : {mesh::Keep::Grounded, mesh::Keep::Largest}) {
        mesh::Mesh mesh = *mesh::polygonize(*blocks, grid, {.threads = 2}, nullptr, counts);
        mesh::keepOnly(mesh, keep, grid.cell_m);
        Volume level = *sample(*blocks, tape, grid, 3, 2, nullptr);
        ASSERT_TRUE(keepOnly(level, keep, grid.cell_m, nullptr).ok());
        EXPECT_NEAR(level.enclosed_m3(), mesh::measure(mesh).volume_m3, 0.02);
    }
}

/// A band without a voxel inside: thinner than a voxel.
TEST(Keep, NothingInsideIsNothingToTakeOut) {
    KnownSolid sheet;
    sheet.field.value = abs(sheet.graph->y() - 0.013f) - 1e-4f;
    sheet.field.bounds = {{-0.5f, -0.1f, -0.5f}, {0.5f, 0.1f, 0.5f}};
    sheet.field.value = max(sheet.field.value, max(abs(sheet.graph->x()), abs(sheet.graph->z())) - 0.5f);
    Volume level = *levelSetOf(sheet, 0.05f);
    const uint64_t before = level.activeVoxels();
    ASSERT_TRUE(keepOnly(level, mesh::Keep::Grounded, level.voxel_m(), nullptr).ok());
    EXPECT_EQ(level.activeVoxels(), before);
}

/// Parts that hang together only around corners of leaves, in every direction.
TEST(Keep, WaysAcrossLeavesAreFound) {
    KnownSolid solid;
    field::Graph& g = *solid.graph;
    const auto rod = [&](Vec3f from, Vec3f to) {
        const auto across = [&](field::NodeRef v, float a, float b) {
            return abs(v - (a + b) / 2) - (std::abs(b - a) / 2 + 0.07f);
        };
        return max(max(across(g.x(), from.x, to.x), across(g.y(), from.y, to.y)), across(g.z(), from.z, to.z));
    };
    // From the ground up, then along x, z, and down again, without touching it; a rod of its own hangs beside.
    solid.field.value = min(min(rod({0, 0, 0}, {0, 3, 0}), rod({0, 3, 0}, {3, 3, 0})),
                            min(rod({3, 3, 0}, {3, 3, 3}), rod({3, 1, 3}, {3, 3, 3})));
    solid.field.value = min(solid.field.value, rod({1, 1, 1}, {2, 1, 1}));
    solid.field.bounds = {{-0.1f, -0.1f, -0.1f}, {3.1f, 3.1f, 3.1f}};
    Volume level = *levelSetOf(solid, 0.05f);
    ASSERT_EQ(mesh::measure(*toMesh(level)).components, 2u);
    ASSERT_TRUE(keepOnly(level, mesh::Keep::Grounded, level.voxel_m(), nullptr).ok());
    EXPECT_EQ(mesh::measure(*toMesh(level)).components, 1u);
    EXPECT_LT(level.at({3, 1.2f, 3}), 0);
    EXPECT_GT(level.at({1.5f, 1, 1}), 0);
}

}  // namespace
}  // namespace sgm::volume
