// Buildings of round sizes in cells of round sizes: planes of the one lie where samples of the other would.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/load.h"
#include "grammar/pipeline/mesh_edits.h"
#include "grammar/pipeline/meshing.h"

namespace sgm::pipeline {
namespace {

/// Triangles of a simplified crisp mesh.
size_t trianglesOf(const std::string& body, double cell_m) {
    syntax::Diagnostics problems;
    const auto grammar = load("round.sgm",
                              "grammar 2\nterminal a color #c04040\nterminal b color #4040c0\n"
                              "start S -> size (12m, 3m, 9m) Two\n" +
                                  body,
                              problems);
    EXPECT_TRUE(grammar);
    if (!grammar) return 0;
    Context context{nullptr, 2};
    const auto model = makeModel(grammar, *optionsFor(*grammar, {}), context);
    const mesh::Grid grid = gridOver(*model, {.cell_m = cell_m}, mesh::Surface::Crisp);
    auto meshed = makeMesh(*model, grid, {.surface = mesh::Surface::Crisp}, context);
    return edited(std::move(meshed->mesh), {}, {model->tape, mesh::Surface::Crisp, grid.cell_m}, context)
        ->triangleCount();
}

TEST(RoundSizes, CostNoTriangles) {
    // A slab on a lower one that stands back: 4 sides, 4 sides, top, bottom and the ring between them.
    constexpr size_t exact = 2 * 4 + 2 * 4 + 2 + 2 + 8;
    for (const double cell_m : {.1, .12, .15, .2, .25, .3, .4, .5})
        for (const char* back : {"size (11.4m, 100%, 8.4m)", "offset -.3m", "size (10m, 100%, 8m)"})
            EXPECT_EQ(trianglesOf(fmt::format("rule Two -> split y {{ 1.5m: {} a | ~1: b }}\n", back), cell_m), exact)
                << cell_m << ' ' << back;
}

TEST(RoundSizes, CostNoTrianglesInNotches) {
    // A cube less a smaller one in its corner: 6 faces of which 3 have a notch, and the notch's 3.
    constexpr size_t exact = 3 * 2 + 3 * 4 + 3 * 2;
    for (const double cell_m : {.1, .15, .2, .25, .3, .5})
        EXPECT_EQ(trianglesOf("rule Two -> a - b size (6m, 1.5m, 4.5m) move (3m, .75m, 2.25m)\n", cell_m), exact)
            << cell_m;
}

}  // namespace
}  // namespace sgm::pipeline
