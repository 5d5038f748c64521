// Meshing again after a change: the same bytes as from the start, and only what changed is made.
#include "modeler/mesh/rebuild.h"

#include <gtest/gtest.h>

#include "tests/mesh/mesh_bytes.h"
#include "tests/mesh/scenes.h"

namespace sgm::mesh {
namespace {

/// Balls in a row of slots, so that a ball can be moved without touching the others.
Scene ballsOf(const std::vector<Vec3f>& centres, float radius) {
    Scene scene;
    std::vector<field::Owned> parts;
    for (size_t i = 0; i < centres.size(); ++i)
        parts.push_back({ball(scene.graph, centres[i], radius), static_cast<OriginId>(i + 1)});
    scene.field = field::sum(scene.graph, parts);
    return scene;
}

std::vector<Vec3f> row(int n) {
    std::vector<Vec3f> centres;
    for (int i = 0; i < n; ++i) centres.push_back({4.0f * static_cast<float>(i), 0, 0});
    return centres;
}

const Grid grid{{-3, -3, -3}, 0.05f, {920, 120, 120}};

/// Brings `rebuild` up to the scene, and compares with a mesh from the start.
void expectSame(Rebuild& rebuild, const Scene& scene, const Grid& on) {
    Counts counts;
    const auto mesh = rebuild.update(scene.tape(), on, nullptr, counts);
    ASSERT_TRUE(mesh.ok());
    const BuiltMesh whole = meshOf(scene.tape(), on);
    ASSERT_TRUE(whole.mesh.ok());
    EXPECT_EQ(bytesOf(**mesh), bytesOf(*whole.mesh));
}

TEST(Rebuild, OnlyWhatChangedIsMade) {
    Rebuild rebuild({.threads = 2});
    std::vector<Vec3f> centres = row(11);
    expectSame(rebuild, ballsOf(centres, 1), grid);
    EXPECT_EQ(rebuild.blocksKept(), 0u);
    const size_t all = rebuild.blocksMade();

    centres[4].y += 0.3f;
    expectSame(rebuild, ballsOf(centres, 1), grid);
    EXPECT_GT(rebuild.blocksMade(), 0u);
    EXPECT_LT(rebuild.blocksMade(), all / 5);

    expectSame(rebuild, ballsOf(centres, 1), grid);
    EXPECT_EQ(rebuild.blocksMade(), 0u);
}

TEST(Rebuild, PartsComeAndGo) {
    Rebuild rebuild({.threads = 2});
    std::vector<Vec3f> centres = row(6);
    expectSame(rebuild, ballsOf(centres, 1), grid);
    centres.push_back({40, 0, 0});
    expectSame(rebuild, ballsOf(centres, 1), grid);
    EXPECT_GT(rebuild.blocksKept(), 0u);
    centres.pop_back();
    expectSame(rebuild, ballsOf(centres, 1), grid);
    expectSame(rebuild, ballsOf({{100, 0, 0}}, 1), grid);  // nothing is left in the grid
    expectSame(rebuild, ballsOf(centres, 1), grid);
}

TEST(Rebuild, AnotherGridKeepsNothing) {
    Rebuild rebuild({.threads = 2});
    const Scene scene = ballsOf(row(3), 1);
    expectSame(rebuild, scene, grid);
    Grid finer = grid;
    finer.cell_m = 0.0625f;
    expectSame(rebuild, scene, finer);
    EXPECT_EQ(rebuild.blocksKept(), 0u);
}

TEST(Rebuild, AfterAnErrorItStartsAfresh) {
    Rebuild rebuild({.threads = 2});
    const Scene scene = ballsOf(row(3), 1), moved = ballsOf(row(4), 1);
    expectSame(rebuild, scene, grid);
    Progress progress;
    progress.cancel();
    Counts counts;
    EXPECT_FALSE(rebuild.update(moved.tape(), grid, &progress, counts).ok());
    expectSame(rebuild, moved, grid);
}

TEST(GridToKeep, StaysWhileTheBoundsFit) {
    const Box3f box{{0, 0, 0}, {10, 5, 5}};
    const Grid first = gridToKeep({}, box, 0.1f);
    const auto same = [](const Grid& a, const Grid& b) { return a.origin == b.origin && a.cells == b.cells; };
    EXPECT_TRUE(same(gridToKeep(first, {{0, 0, 0}, {10.8f, 5.5f, 5}}, 0.1f), first));
    EXPECT_TRUE(same(gridToKeep(first, {{4, 1, 1}, {5, 2, 2}}, 0.1f), first));
    const Box3f larger{{0, 0, 0}, {12, 5, 5}};
    const Grid second = gridToKeep(first, larger, 0.1f);
    EXPECT_FALSE(same(second, first));
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LT(second.corner(1, 1, 1)[axis], larger.lo[axis]);
        EXPECT_GT(second.corner(second.cells.x - 1, second.cells.y - 1, second.cells.z - 1)[axis], larger.hi[axis]);
    }
    EXPECT_EQ(gridToKeep(first, larger, 0.2f).cell_m, 0.2f);
}

}  // namespace
}  // namespace sgm::mesh
