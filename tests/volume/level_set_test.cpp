// Level sets sampled from fields with known distances.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "modeler/core/conventions.h"
#include "modeler/eval/evaluate.h"
#include "modeler/field/field.h"
#include "modeler/mesh/validate.h"
#include "modeler/volume/volume.h"
#include "tests/scratch.h"
#include "tests/stop_time.h"

namespace sgm::volume {
namespace {

constexpr Vec3f centre{0.13f, -0.21f, 0.07f};

/// slope · (|p − centre| − radius); a slope of 1 is a true distance.
eval::Tape sphereTape(float radius, float slope = 1) {
    field::Graph graph;
    const auto x = graph.x() - centre.x, y = graph.y() - centre.y, z = graph.z() - centre.z;
    field::Field field;
    field.value = (sqrt(x * x + y * y + z * z) - radius) * slope;
    field.lipschitz = slope;
    return eval::compile(graph, field, graph.constants());
}

mesh::Grid sphereGrid(float radius, float voxel_m) {
    const Vec3f r{radius, radius, radius};
    return mesh::gridFor({centre - r, centre + r}, voxel_m);
}

Result<Volume> sampleTape(const eval::Tape& tape, const mesh::Grid& grid, int halfWidth = 3, int threads = 2) {
    mesh::Counts counts;
    auto blocks = mesh::subdivide(tape, grid, threads, nullptr, counts);
    if (!blocks.ok()) return blocks.error();
    return sample(*blocks, tape, grid, halfWidth, threads, nullptr);
}

Volume sphere(float radius, float voxel_m, int threads = 2) {
    auto volume = sampleTape(sphereTape(radius), sphereGrid(radius, voxel_m), 3, threads);
    EXPECT_TRUE(volume.ok());
    return std::move(volume).value();
}

/// Largest difference between the volume and clamp(slope · distance, ±band) over every corner, `margin` beyond the
/// grid.
float worstDifference(const Volume& volume, const mesh::Grid& grid, float radius, float slope, float band, int margin) {
    float worst = 0;
    for (int i = -margin; i <= grid.cells.x + margin; ++i)
        for (int j = -margin; j <= grid.cells.y + margin; ++j)
            for (int k = -margin; k <= grid.cells.z + margin; ++k) {
                const Vec3f p = grid.corner(i, j, k);
                const float expected = std::clamp(slope * (length(p - centre) - radius), -band, band);
                worst = std::max(worst, std::abs(volume.at(p) - expected));
            }
    return worst;
}

TEST(LevelSet, HoldsTheClampedFieldEverywhere) {
    // 1 m at these voxels: surface in several blocks, some of it close to a block's side, and blocks with none.
    for (const float voxel_m : {0.07f, 0.031f, 0.0208f}) {
        const mesh::Grid grid = sphereGrid(1, voxel_m);
        const Volume v = sphere(1, voxel_m);
        EXPECT_FLOAT_EQ(v.voxel_m(), voxel_m);
        EXPECT_LT(worstDifference(v, grid, 1, 1, 3 * voxel_m, 5), 1e-6f) << voxel_m;
        // Active voxels fill a shell six voxels thick.
        EXPECT_NEAR(static_cast<double>(v.activeVoxels()) * std::pow(voxel_m, 3), 4 * pi * 6 * voxel_m,
                    0.05 * 4 * pi * 6 * voxel_m);
    }
}

TEST(LevelSet, BandIsCompleteAcrossBlocksWithoutSurface) {
    // A sphere that ends just before a block's side: the outer band lies in the next blocks, which hold no surface.
    const float voxel_m = 0.05f, radius = 0.75f;
    mesh::Grid grid;
    grid.cell_m = voxel_m;
    grid.origin = centre - Vec3f{16, 16, 16} * voxel_m;  // the sphere reaches from corner 1 to corner 31
    grid.cells = {32, 32, 32};
    const auto tape = sphereTape(radius);
    for (const int halfWidth : {1, 3, 20}) {
        const auto v = sampleTape(tape, grid, halfWidth);
        ASSERT_TRUE(v.ok());
        EXPECT_LT(worstDifference(*v, grid, radius, 1, static_cast<float>(halfWidth) * voxel_m, 31), 1e-6f)
            << halfWidth;
    }
}

TEST(LevelSet, SignsAreRightWhereTheFieldIsSteep) {
    // The values pass the whole band between two voxels, so that no voxel is active.
    const float voxel_m = 0.05f, slope = 1000;
    const mesh::Grid grid = sphereGrid(1, voxel_m);
    const auto v = sampleTape(sphereTape(1, slope), grid);
    ASSERT_TRUE(v.ok());
    EXPECT_LT(worstDifference(*v, grid, 1, slope, 3 * voxel_m, 2), 2e-4f);
}

TEST(LevelSet, VolumeConverges) {
    const double exact = 4 * pi / 3;
    double before = 1;
    for (const float voxel_m : {0.1f, 0.05f, 0.025f}) {
        const double error = std::abs(sphere(1, voxel_m).enclosed_m3() - exact) / exact;
        EXPECT_LT(error, before / 2) << voxel_m;
        before = error;
    }
    EXPECT_LT(before, 1e-3);
}

TEST(LevelSet, BecomesAClosedOutwardMesh) {
    const auto meshed = toMesh(sphere(1, 0.05f));
    ASSERT_TRUE(meshed.ok());
    const mesh::MeshFigures figures = mesh::measure(*meshed);
    EXPECT_EQ(figures.boundaryEdges, 0u);
    EXPECT_EQ(figures.nonmanifoldEdges, 0u);
    EXPECT_EQ(figures.euler, 2);
    EXPECT_NEAR(figures.volume_m3, 4 * pi / 3, 0.02);
    const mesh::Chunk& chunk = meshed->chunks[0];
    for (size_t i = 0; i < chunk.positions.size(); ++i)
        ASSERT_GT(dot(chunk.normals[i], normalized(chunk.positions[i] - centre)), 0.98f);
}

TEST(LevelSet, EmptyWhereThereIsNoSurface) {
    const auto tape = sphereTape(1);
    const auto v = sample({}, tape, sphereGrid(1, 0.1f), 3, 1, nullptr);
    ASSERT_TRUE(v.ok());
    EXPECT_EQ(v->activeVoxels(), 0u);
    EXPECT_EQ(v->enclosed_m3(), 0);
    EXPECT_FLOAT_EQ(v->at(centre), 0.3f);
}

TEST(LevelSet, RefusesBandsItCannotFillAndStopsWhenCancelled) {
    const auto tape = sphereTape(1);
    EXPECT_EQ(sampleTape(tape, sphereGrid(1, 0.1f), 0).error().kind, Error::Kind::Usage);
    EXPECT_EQ(sampleTape(tape, sphereGrid(1, 0.1f), 33).error().kind, Error::Kind::Usage);
    mesh::Counts counts;
    const auto grid = sphereGrid(1, 0.1f);
    const auto blocks = mesh::subdivide(tape, grid, 1, nullptr, counts);
    Progress progress;
    progress.cancel();
    EXPECT_EQ(sample(*blocks, tape, grid, 3, 1, &progress).error().kind, Error::Kind::Cancelled);
}

TEST(VdbFile, ReadsBackWhatWasWritten) {
    const Scratch folder;
    const Volume v = sphere(1, 0.05f);
    ASSERT_TRUE(writeVdb(v, folder / "a.vdb", "level_set").ok());
    const auto r = readVdb(folder / "a.vdb");
    ASSERT_TRUE(r.ok());
    EXPECT_EQ(r->activeVoxels(), v.activeVoxels());
    EXPECT_FLOAT_EQ(r->voxel_m(), v.voxel_m());
    EXPECT_DOUBLE_EQ(r->enclosed_m3(), v.enclosed_m3());
    const mesh::Grid grid = sphereGrid(1, 0.05f);
    for (int i = -2; i < grid.cells.x + 2; ++i)
        for (int j = 0; j < grid.cells.y; j += 3)
            for (int k = 0; k < grid.cells.z; k += 5)
                ASSERT_EQ(r->at(grid.corner(i, j, k)), v.at(grid.corner(i, j, k)));
}

TEST(Sample, RefusesAGridThatIsNone) {
    const eval::Tape tape = sphereTape(1);
    mesh::Grid grid = sphereGrid(1, 0.1f);
    grid.cell_m = 0;
    const auto volume = sample({}, tape, grid, 3, 1, nullptr);
    ASSERT_FALSE(volume.ok());
    EXPECT_EQ(volume.error().kind, Error::Kind::Input);
}

TEST(Sample, StopsWithinABatchOfBlocks) {
    // One batch, on one thread, of a field that takes far longer than the wait for the answer.
    field::Graph graph;
    field::NodeRef f = length(graph.position()) - 1.0f;
    for (int i = 1; i < 4000; ++i) f = f + sin(graph.x() * static_cast<float>(i)) * 1e-9f;
    const eval::Tape tape = eval::compile(graph, {f, {}, 1, 1}, graph.constants());
    const mesh::Grid grid = sphereGrid(1, 0.05f);
    mesh::Counts counts;
    const auto blocks = mesh::subdivide(tape, grid, 2, nullptr, counts);
    ASSERT_TRUE(blocks.ok());
    const double late_s = leastSecondsToStop(
        boundSeconds(.05), threadClock(),
        [waits = 0](const Progress& progress) mutable { return *progress.stage() != 0 && ++waits % 30 == 0; },
        [&](Progress& progress) {
            const auto volume = sample(*blocks, tape, grid, 3, 1, &progress);
            ASSERT_FALSE(volume.ok());
            EXPECT_EQ(volume.error().kind, Error::Kind::Cancelled);
        });
    EXPECT_LT(late_s, boundSeconds(.05));
}

TEST(VdbFile, TellsWhatItHolds) {
    const Scratch folder;
    ASSERT_TRUE(writeVdb(sphere(1, 0.1f), folder / "a.vdb", "rock", {false, {{"seed", "17"}}}).ok());
    const std::string bytes = contentOf(folder / "a.vdb");
    for (const char* text : {"rock", "level set", "creator", "sgm", "seed", "17", "file_voxel_count", "file_bbox_min"})
        EXPECT_NE(bytes.find(text), std::string::npos) << text;
}

TEST(VdbFile, HalfFloatsAreSmallerAndClose) {
    const Scratch folder;
    const Volume v = sphere(1, 0.0125f);
    ASSERT_TRUE(writeVdb(v, folder / "full.vdb", "a").ok());
    ASSERT_TRUE(writeVdb(v, folder / "half.vdb", "a", {true, {}}).ok());
    EXPECT_LT(std::filesystem::file_size(folder / "half.vdb"), 3 * std::filesystem::file_size(folder / "full.vdb") / 4);
    const auto r = readVdb(folder / "half.vdb");
    ASSERT_TRUE(r.ok());
    EXPECT_NEAR(r->enclosed_m3(), v.enclosed_m3(), 1e-3);
}

TEST(VdbFile, HasTheSameBytesAtAnyThreadCount) {
    const Scratch folder;
    std::string first;
    for (const int threads : {1, 2, 5}) {
        ASSERT_TRUE(writeVdb(sphere(1, 0.03f, threads), folder / "a.vdb", "level_set").ok());
        const std::string bytes = contentOf(folder / "a.vdb");
        if (first.empty()) first = bytes;
        EXPECT_EQ(bytes == first, true) << threads << " threads";
    }
    ASSERT_TRUE(writeVdb(sphere(0.9f, 0.03f), folder / "b.vdb", "level_set").ok());
    // The tag that identifies the content differs with the content.
    EXPECT_NE(contentOf(folder / "b.vdb").substr(21, 36), first.substr(21, 36));
    EXPECT_EQ(first[29], '-');
}

TEST(VdbFile, RefusesWhatIsNoVolume) {
    const Scratch folder;
    EXPECT_EQ(readVdb(folder / "missing.vdb").error().kind, Error::Kind::Input);
    std::ofstream(folder / "text.vdb") << "this is no volume, but a text of some length";
    const auto r = readVdb(folder / "text.vdb");
    ASSERT_FALSE(r.ok());
    EXPECT_NE(r.error().message.find("cannot read"), std::string::npos);
    ASSERT_TRUE(writeVdb(sphere(1, 0.1f), folder / "a.vdb", "level_set").ok());
    const std::string bytes = contentOf(folder / "a.vdb");
    std::ofstream(folder / "cut.vdb", std::ios::binary) << bytes.substr(0, bytes.size() / 2);
    EXPECT_FALSE(readVdb(folder / "cut.vdb").ok());
    EXPECT_FALSE(writeVdb(sphere(1, 0.1f), folder / "missing/a.vdb", "level_set").ok());
}

}  // namespace
}  // namespace sgm::volume
