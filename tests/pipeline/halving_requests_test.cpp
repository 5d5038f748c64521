// Which cells are halved for which parts, and when all of them are.
#include "grammar/pipeline/halving_requests.h"

#include <gtest/gtest.h>

#include "modeler/mesh/validate.h"
#include "tests/mesh/mesh_bytes.h"
#include "tests/pipeline/crisp_model.h"

namespace sgm::pipeline {
namespace {

HalvingRequest requestFor(OriginId part, std::vector<Vec3i> cells) { return {{part, false, -1}, std::move(cells), 0}; }

TEST(HalvingRequests, LeaveCellsToThoseThatAreHalvedOftener) {
    RequestsByHalvings asked;
    asked[1] = {requestFor(1, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}})};
    asked[2] = {requestFor(2, {{1, 0, 0}, {3, 0, 0}})};
    asked[3] = {requestFor(3, {{3, 0, 0}})};
    leaveOutFiner(asked);
    EXPECT_EQ(asked[1][0].cells, (std::vector<Vec3i>{{0, 0, 0}, {2, 0, 0}}));
    EXPECT_EQ(asked[2][0].cells, (std::vector<Vec3i>{{1, 0, 0}}));
    EXPECT_EQ(asked[3][0].cells, (std::vector<Vec3i>{{3, 0, 0}}));
}

TEST(HalvingRequests, HalveAllCellsWhereMostOfThemAreAskedFor) {
    constexpr size_t triangles = 30'000, most = 8'000'000;
    EXPECT_EQ(halvingsOfAll({0, 1'200, 0, 0}, triangles, 3, most), 0);
    EXPECT_EQ(halvingsOfAll({0, 100'000, 0, 0}, triangles, 3, most), 1);
    EXPECT_EQ(halvingsOfAll({0, 0, 400'000, 0}, triangles, 3, most), 2);
    EXPECT_EQ(halvingsOfAll({0, 0, 400'000, 0}, triangles, 1, most), 1);
    EXPECT_EQ(halvingsOfAll({0, 0, 400'000, 0}, triangles, 3, 4 * triangles), 0);
}

TEST(HalvingRequests, OfASampleMultiplyToNoMoreThanAllCells) {
    const size_t triangles = 3'000;  // of 1,000 cells
    EXPECT_NEAR(static_cast<double>(multiplied({0, 12, 0, 0}, 8, triangles)[1]), 96, 1);
    EXPECT_LE(multiplied({0, 6'000, 0, 0}, 8, triangles)[1], 12'000u);
    EXPECT_EQ(multiplied({}, 8, triangles), GrowthByHalvings{});
}

/// Cells that were halved once took some with them that had been halved three times: the frames there were lost. In
/// cells half and a quarter as large the volume is 4,317.21 m³.
TEST(Refining, CellsThatWereHalvedMoreStaySo) {
    Context context{nullptr, 2};
    const Model model = modelOf(fileText("examples/buildings/spire.sgm"), context);
    EXPECT_NEAR(mesh::measure(meshed(model, 128, 3).mesh).volume_m3, 4317.21, 1.5);
}

/// Columns, rails and bars of a cloister are thinner than its cells all over: in cells of 1/512 of its length it has
/// 8,732.1 m³.
TEST(HalvingRequests, OfACloisterInLargeCellsAreAllCells) {
    Context context{nullptr, 2};
    const Model model = modelOf(fileText("examples/buildings/cloister.sgm"), context);
    const mesh::Grid grid = gridOf(model, 48);
    const auto meshedBy = [&](bool halvesAll, int threads) {
        Context own{nullptr, threads};
        auto made = makeMesh(model, grid, {.surface = mesh::Surface::Crisp, .halvesAll = halvesAll}, own);
        EXPECT_NEAR(mesh::measure(made.value().mesh).volume_m3, 8732.1, 2) << halvesAll;
        return std::move(*made);
    };
    const MeshedModel all = meshedBy(true, 1), some = meshedBy(false, 2);
    EXPECT_GT(all.counts.surfaceCells, 4 * some.counts.surfaceCells);
    EXPECT_EQ(mesh::bytesOf(meshedBy(true, 3).mesh), mesh::bytesOf(all.mesh));
}

}  // namespace
}  // namespace sgm::pipeline
