// The preview's mesh by compute shaders beside the CPU's, which is not refined for this.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "modeler/eval/evaluate.h"
#include "modeler/mesh/polygonize.h"
#include "tests/render/gpu_fixture.h"
#include "tests/render/scenes.h"
#include "viewer/render/blocks_scene.h"

namespace sgm::render::test {
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
        for (const mesh::Chunk& chunk : cpu->chunks)
            ours.insert(ours.end(), chunk.positions.begin(), chunk.positions.end());
        const auto before = [](const Vec3f& a, const Vec3f& b) { return a.x < b.x; };
        std::sort(ours.begin(), ours.end(), before);
        std::sort(theirs.begin(), theirs.end(), before);
        const float near = 2e-4f * cell_m;
        const auto missing = [&](const std::vector<Vec3f>& from, const std::vector<Vec3f>& in) {
            return std::count_if(from.begin(), from.end(), [&](const Vec3f& p) {
                for (auto q = std::lower_bound(in.begin(), in.end(), Vec3f{p.x - near, 0, 0}, before);
                     q != in.end() && q->x <= p.x + near; ++q)
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

TEST_F(Blocks, KnowWhoseEachTriangleIs) {
    Scene scene;
    scene.add("sphere", {0, 0, 0}, {1, 1, 1}, {1, 0, 0});
    scene.add("torus", {0.9, 0.3, 0.1}, {0.8, 0.3, 0.8}, {0, 1, 0});
    const field::Field field = scene.sum();
    const eval::Tape tape = scene.compile(field);
    const auto gpu = GpuContext::create();
    ASSERT_TRUE(gpu.ok());
    const auto blocks = prepareBlocks(tape, mesh::gridFor(field.bounds, 0.02f), 1, nullptr);
    ASSERT_TRUE(blocks.ok());
    ASSERT_GT(blocks->blocks.size(), 8u);
    const auto programs = programsFor(*blocks, nullptr);
    ASSERT_TRUE(programs.ok());
    const auto triangles = polygonizeOnGpu(*blocks, **programs, nullptr);
    ASSERT_TRUE(triangles.ok());
    const std::vector<Vec3f> corners = triangles->positions.read<Vec3f>(triangles->count * 3);
    std::vector<float> x, y, z;
    for (size_t t = 0; t < triangles->count; ++t) {
        const Vec3f middle = (corners[3 * t] + corners[3 * t + 1] + corners[3 * t + 2]) / 3.0f;
        x.push_back(middle.x), y.push_back(middle.y), z.push_back(middle.z);
    }
    std::vector<OriginId> whole(x.size());
    eval::Workspace workspace;
    eval::evaluateOrigin(tape, {x.data(), y.data(), z.data(), x.size()}, whole.data(), workspace);
    EXPECT_EQ(ownersOf(*blocks, *triangles, 1), whole);
    for (const OriginId owner : {1u, 2u}) EXPECT_GT(std::count(whole.begin(), whole.end(), owner), 1000);
}

}  // namespace
}  // namespace sgm::render::test
