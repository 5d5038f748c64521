// Rims of round buildings: near an edge between two walls, the crease of wall and roof leaves faces of cells.
#include <gtest/gtest.h>

#include <cmath>

#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/load.h"
#include "grammar/pipeline/mesh_edits.h"
#include "grammar/pipeline/meshing.h"
#include "modeler/core/conventions.h"

namespace sgm::pipeline {
namespace {

TEST(Rims, OfPrismsHaveNoChamfers) {
    syntax::Diagnostics problems;
    const auto grammar =
        load("drum.sgm", "grammar 2\nterminal solid\nstart A -> size (40m, 12m, 40m) solid footprint ngon(64, 20m)\n",
             problems);
    ASSERT_TRUE(grammar);
    Context context{nullptr, 2};
    const auto model = makeModel(grammar, *optionsFor(*grammar, {}), context);
    const mesh::Grid grid = gridOf(*model, 512);
    auto meshed = makeMesh(*model, grid, {.surface = mesh::Surface::Crisp}, context);
    ASSERT_TRUE(meshed.ok());
    const auto mesh = edited(std::move(meshed->mesh), {}, {model->tape, mesh::Surface::Crisp, grid.cell_m}, context);
    ASSERT_TRUE(mesh.ok());
    const double apothem_m = 20 * std::cos(pi / 64);
    for (const mesh::Chunk& chunk : mesh->chunks)
        for (const Vec3f p : chunk.positions)
            EXPECT_GT(std::hypot(p.x, p.z), apothem_m - 1e-4) << p.x << ' ' << p.y << ' ' << p.z;
}

}  // namespace
}  // namespace sgm::pipeline
