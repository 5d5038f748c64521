// Simplified meshes of rough ground, judged by CGAL.
#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/mesh_edits.h"
#include "grammar/pipeline/meshing.h"
#include "grammar/pipeline/model.h"
#include "modeler/mesh/validate.h"
#include "tests/derive/grammars.h"

namespace sgm::pipeline {
namespace {

/// The mesh as it is written.
Result<mesh::Mesh> written(const char* text, uint64_t seed, int cells) {
    Context context;
    context.threads = 2;
    derive::Options options;
    options.seed = seed;
    const auto model = makeModel(testing_::grammarOf(text), options, context);
    if (!model.ok()) return model.error();
    auto meshed = makeMesh(*model, gridOf(*model, cells), {.surface = mesh::Surface::Crisp}, context);
    if (!meshed.ok()) return meshed.error();
    return edited(std::move(meshed->mesh), {}, {model->tape, mesh::Surface::Crisp, meshed->grid.cell_m}, context);
}

TEST(Simplified, RoughBedsCrossNothing) {
    const auto mesh = written(
        "grammar 2\nstart L -> size (90m, 40m, 90m) M displace fbm(1.4m, .12/m, 4)\n"
        "rule M -> split y { { ~4m: B }* }\n"
        "rule B -> cube size (100% - (0m..1m), 102%, 100% - (0m..1m))\n",
        4, 128);
    ASSERT_TRUE(mesh.ok()) << mesh.error().message;
    const auto judged = mesh::validate(*mesh);
    ASSERT_TRUE(judged.ok());
    EXPECT_TRUE(judged->closed);
    EXPECT_FALSE(judged->selfIntersects);
}

/// The ridges of wings run into slopes of the others, on faces whose crossings lie outside them.
TEST(Simplified, RidgesThatRunIntoSlopesCostFewTriangles) {
    size_t triangles = 0;
    for (const char* roof :
         {"ell(16, 12, 5, 6) extrude 4m gableRoof(45deg)", "tee(16, 12, 5, 6) extrude 4m hipRoof(40deg)"})
        for (const int cells : {96, 128}) {
            const auto mesh =
                written(("grammar 2\nstart A -> footprint " + std::string(roof) + "\n").c_str(), 1, cells);
            ASSERT_TRUE(mesh.ok()) << mesh.error().message;
            triangles += mesh->triangleCount();
        }
    EXPECT_LE(triangles, 200u);
}

}  // namespace
}  // namespace sgm::pipeline
