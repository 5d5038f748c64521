// The preview's mesh by compute shaders beside the CPU's, which is not refined for this.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "modeler/mesh/polygonize.h"
#include "tests/viewer/gpu_fixture.h"
#include "tests/viewer/scenes.h"
#include "viewer/blocks_scene.h"

namespace sgm::viewer::test {
namespace {

class Blocks : public OnGpu {
protected:
    /// The same triangle count, and every vertex of one among those of the other.
    static void expectSame(const eval::Tape& tape, const Box3f& bounds, float cell_m) {
        const mesh::Grid grid = mesh::gridFor(bounds, cell_m);
        mesh::Counts counts;
        const auto blocks = mesh::subdivide(tape, grid, 1, nullptr, counts);
        ASSERT_TRUE(blocks.ok());
        const auto cpu = mesh::polygonize(*blocks, grid, {.threads = 1, .refineSteps = 0}, nullptr, counts);
        const auto gpu = polygonizeOnGpu(tape, grid);
        ASSERT_TRUE(cpu.ok() && gpu.ok()) << gpu.error().message;
        EXPECT_GT(cpu->triangleCount(), 1000u);
        EXPECT_EQ(gpu->size(), cpu->triangleCount() * 3);
        std::vector<Vec3f> ours, theirs = *gpu;
        for (const mesh::Chunk& chunk : cpu->chunks) ours.insert(ours.end(), chunk.positions.begin(), chunk.positions.end());
        const auto before = [](const Vec3f& a, const Vec3f& b) { return a.x < b.x; };
        std::sort(ours.begin(), ours.end(), before);
        std::sort(theirs.begin(), theirs.end(), before);
        const float near = 2e-4f * cell_m;
        const auto missing = [&](const std::vector<Vec3f>& from, const std::vector<Vec3f>& in) {
            return std::count_if(from.begin(), from.end(), [&](const Vec3f& p) {
                for (auto q = std::lower_bound(in.begin(), in.end(), Vec3f{p.x - near, 0, 0}, before); q != in.end() && q->x <= p.x + near; ++q)
                    if (length(*q - p) < near) return false;
                return true;
            });
        };
        EXPECT_EQ(missing(theirs, ours), 0);
        EXPECT_EQ(missing(ours, theirs), 0);
    }
};

TEST_F(Blocks, AreTheCpusMeshBeforeRefinement) {
    Scene scene;
    scene.add("sphere", {0, 0, 0}, {1, 1, 1}, {1, 1, 1});
    scene.add("torus", {0.9, 0.3, 0.1}, {0.8, 0.3, 0.8}, {1, 1, 1});
    const field::Field field = scene.sum();
    expectSame(scene.compile(field), field.bounds, 0.043f);
}

TEST_F(Blocks, EndAtTheGridsBorder) {
    Scene scene;
    scene.add("cube", {0, 0, 0}, {1, 1, 1}, {1, 1, 1});
    const field::Field field = scene.sum();
    expectSame(scene.compile(field), {{-0.6f, -1.1f, -1.1f}, {1.1f, 0.52f, 1.1f}}, 0.037f);
}

}  // namespace
}  // namespace sgm::viewer::test
