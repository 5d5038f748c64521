#include "modeler/mesh/sample.h"

#include <gtest/gtest.h>

#include "tests/mesh/scenes.h"

namespace sgm::mesh {
namespace {

TEST(Samples, OfEveryBrickAreTheFields) {
    const Scene s = cloudScene(60, 0.16f, 3);
    const eval::Tape tape = s.tape();
    const Grid grid = gridFor(s.field.bounds, cellFor(s.field.bounds, 75));
    Counts counts;
    const auto blocks = subdivide(tape, grid, 1, nullptr, counts);
    ASSERT_TRUE(blocks.ok());
    eval::Workspace workspace;
    BlockSamples samples;
    size_t whole = 0, parts = 0, near = 0;
    for (const Block& block : *blocks) {
        samples.enter(block, grid, workspace, counts);
        for (uint64_t rest = samples.active(); rest != 0; rest &= rest - 1) {
            const int brick = std::countr_zero(rest);
            const uint64_t before = counts.pointEvaluations;
            samples.sample(brick, workspace, counts);
            (counts.pointEvaluations - before == WholeBricks::points ? whole : parts) += 1;
            const BrickValues at = samples.values(brick);
            const Vec3i first = block.index * blockCells + brickAt(brick) * brickCells;
            for (int k = 0; k < brickCorners; ++k)
                for (int j = 0; j < brickCorners; ++j)
                    for (int i = 0; i < brickCorners; ++i) {
                        const Vec3i c = first + Vec3i{i, j, k};
                        if (minComponent(c) == 0 || minComponent(grid.cells - c) <= 0) continue;  // sealed
                        const Vec3f p = grid.corner(c.x, c.y, c.z);
                        float f;
                        eval::evaluate(tape, {&p.x, &p.y, &p.z, 1}, &f, workspace);
                        const float got = at.corner[static_cast<uint32_t>(i) + at.row * static_cast<uint32_t>(j) +
                                                    at.layer * static_cast<uint32_t>(k)];
                        ASSERT_EQ(got < 0, f < 0);
                        if (std::abs(f) > tape.lipschitz() * grid.cell_m) continue;
                        ++near;
                        ASSERT_EQ(got, f);
                    }
        }
    }
    EXPECT_GT(whole, 20u);
    EXPECT_GT(parts, 20u);
    EXPECT_GT(near, 20'000u);
}

}  // namespace
}  // namespace sgm::mesh
