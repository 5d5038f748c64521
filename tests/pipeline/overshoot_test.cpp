// Vertices outside the solid: breaks, corners and what simplification moves stay near the surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "modeler/eval/evaluate.h"
#include "tests/pipeline/crisp_model.h"

namespace sgm::pipeline {
namespace {

/// How far outside the solid each of a mesh's vertices is, in cells, by the field.
std::vector<float> outside(const CrispModel& crisp, const mesh::Mesh& mesh) {
    std::vector<float> x, y, z;
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (const Vec3f p : chunk.positions) x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
    std::vector<float> values(x.size());
    eval::Workspace workspace;
    eval::evaluate(crisp.model.tape, {x.data(), y.data(), z.data(), x.size()}, values.data(), workspace);
    for (float& value : values) value /= crisp.grid.cell_m;
    return values;
}

/// The most of a mesh that `sgm build` would write.
float mostOutside(const std::string& text, int resolution) {
    Context context{nullptr, 2};
    CrispModel crisp = crispModel("grammar 2\n" + text, resolution, context);
    const auto mesh = crisp.edit({}, context);
    EXPECT_TRUE(mesh.ok()) << text;
    const std::vector<float> cells = outside(crisp, *mesh);
    return *std::max_element(cells.begin(), cells.end());
}

/// More pieces than one corner has meet in a cell: what is nearest to all their planes lay a third of a cell outside.
TEST(Overshoot, MouldingsLowerThanTwoCellsStandOutNoFarther) {
    for (const int resolution : {32, 62})
        EXPECT_LT(mostOutside("start Wall -> size (6, .2, .4) stringMoulding(.1m)\n", resolution), .02f) << resolution;
}

/// A vertex below the corner that ends its crease was put above it, as if it had been beyond.
TEST(Overshoot, SimplificationKeepsTheTopsOfRoadsLevel) {
    EXPECT_LT(mostOutside("roads Net { pull = 1 spread = true highway = 40m street = 10m step = 40m block = 40m "
                          "junction = 3 snap = 12m }\n"
                          "start Town -> size (300, 10, 300) network Net { ground: extrude 4m cube | street: extrude "
                          "4.2m cube | highway: extrude 4.2m cube | crossing: extrude 4.2m cube }\n",
                          128),
              .05f);
}

/// Below a ledge less deep than a cell the way over the breaks goes to and fro: it was cut short where the underside
/// lies near the side of a cell, as at 170 vertices of the apartment's bars. 40 are left where more parts meet.
TEST(Overshoot, LedgesLessDeepThanACellHaveTheirUndersides) {
    const std::string text = fileText("examples/buildings/apartment.sgm");
    Context context{nullptr, 2};
    const CrispModel crisp = crispModel(text, 200, context);
    const std::vector<float> cells = outside(crisp, crisp.mesh);
    EXPECT_LT(std::count_if(cells.begin(), cells.end(), [](float c) { return c > .1f; }), 60);
}

}  // namespace
}  // namespace sgm::pipeline
