// Simplified meshes of rough ground, judged by CGAL.
#include <algorithm>

#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/mesh_edits.h"
#include "grammar/pipeline/meshing.h"
#include "grammar/pipeline/model.h"
#include "modeler/mesh/validate.h"
#include "tests/derive/grammars.h"
#include "tests/pipeline/crisp_model.h"

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

/// Behind a chimney the roof leaves a wedge that ends in a layer of cells which show none of it: the corners at its
/// foot lie beyond vertices of other creases, across which edges have to turn.
TEST(Simplified, WedgesBehindChimneysEndInTheirCorners) {
    for (const int cells : {90, 96, 97, 104}) {
        const auto mesh = written(
            "grammar 2\nstart Villa -> footprint ell(16, 12, 6, 6.5) extrude 6.4m House\n"
            "rule House -> cube + Attic at +y\n"
            "rule Attic -> Cover, cube size (.7m, 3m, .7m) move (4m, 2.9m - 50%, -4.4m)\n"
            "rule Cover -> offset -.02m gableRoof(60deg, overhang: .6m) move (0, .2m, 0)\n",
            1, cells);
        ASSERT_TRUE(mesh.ok()) << mesh.error().message;
        for (const float x : {3.65f, 4.35f}) {
            const Vec3f corner{x, 9.442858f, -4.05f};
            float nearest = 1;
            for (const mesh::Chunk& chunk : mesh->chunks)
                for (const Vec3f p : chunk.positions) nearest = std::min(nearest, length(p - corner));
            EXPECT_LT(nearest, 1e-4f) << cells;
        }
    }
}

/// The top of the palace's plinth touches itself in one place: all of it kept its 15,000 triangles.
TEST(Simplified, PlanesThatCrossSomewhereKeepTrianglesThereAlone) {
    const std::string text = fileText("examples/buildings/palace.sgm");
    Context context{nullptr, 2};
    const MeshedModel made = meshedInPart(modelOf(text, context), 128);
    const auto mesh = mesh::simplify(made.mesh, {mesh::usualTolerance(made.grid.cell_m), 2}, nullptr);
    ASSERT_TRUE(mesh.ok());
    EXPECT_LT(mesh->triangleCount(), 40000u);
    const auto judged = mesh::validate(*mesh);
    ASSERT_TRUE(judged.ok());
    EXPECT_TRUE(judged->closed && !judged->selfIntersects);
}

}  // namespace
}  // namespace sgm::pipeline
