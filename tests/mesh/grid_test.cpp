// The grids that bounds get, and those that are refused.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "modeler/mesh/polygonize.h"
#include "tests/mesh/scenes.h"

namespace sgm::mesh {
namespace {

TEST(Grid, BoundsNeverPassThroughSamples) {
    for (const int resolution : {7, 32, 64, 100, 333})
        for (const float size : {0.1f, 1.0f, 3.0f, 77.7f}) {
            const Box3f bounds{{-size, 0, -0.31f * size}, {size, size, 0.5f * size}};
            const Grid g = gridFor(bounds, cellFor(bounds, resolution));
            EXPECT_EQ(g.cells.x, resolution + 3);
            for (int axis = 0; axis < 3; ++axis)
                for (const float side : {bounds.lo[axis], bounds.hi[axis]}) {
                    const double at = (double(side) - g.origin[axis]) / g.cell_m;
                    EXPECT_GT(std::abs(at - std::round(at)), 0.2);
                    EXPECT_GT(at, 1);
                    EXPECT_LT(at, g.cells[axis] - 1);
                }
        }
}

TEST(Grid, BudgetsAndImpossibleGridsAreErrors) {
    PolygonizeOptions options;
    options.memoryBudget_bytes = 1 << 20;
    const BuiltMesh m = meshOf(ballScene(), 128, 2, options);
    ASSERT_FALSE(m.mesh.ok());
    EXPECT_EQ(m.mesh.error().kind, Error::Kind::Budget);
    const eval::Tape tape = ballScene().tape();
    EXPECT_EQ(meshOf(tape, {{1e6f, 0, 0}, 0.01f, {8, 8, 8}}).mesh.error().kind, Error::Kind::Input);
    EXPECT_EQ(meshOf(tape, {{0, 0, 0}, 0, {8, 8, 8}}).mesh.error().kind, Error::Kind::Input);
    EXPECT_EQ(meshOf(tape, gridFor({{-1, -1, -1}, {1, 1, 1}}, 1e-6f)).mesh.error().kind, Error::Kind::Budget);
    // Boxes without end or sense, and what cellFor makes of them.
    constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    for (const Box3f& box : {Box3f{{-inf, -inf, -inf}, {inf, 0, inf}}, Box3f{{inf, 0, 0}, {inf, 1, 1}},
                             Box3f{{nan, 0, 0}, {1, 1, 1}}, Box3f{{0, 0, 0}, {1, nan, 1}}})
        for (const float cell : {0.1f, cellFor(box, 64), inf, nan, -1.0f})
            EXPECT_EQ(meshOf(tape, gridFor(box, cell)).mesh.error().kind, Error::Kind::Input);
}

TEST(Grid, FlatBoxesHaveAGrid) {
    const Grid g = gridFor({{1, 2, 3}, {1, 2, 3}}, cellFor({{1, 2, 3}, {1, 2, 3}}, 64));
    EXPECT_EQ(g.cells, (Vec3i{3, 3, 3}));
    EXPECT_EQ(meshOf(ballScene().tape(), g).mesh.value().triangleCount(), 0u);
}

}  // namespace
}  // namespace sgm::mesh
