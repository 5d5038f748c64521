// Models whose walls stand across the grid: their meshes are those of models that stand along it.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "grammar/derive/turn.h"
#include "modeler/core/conventions.h"
#include "modeler/core/packages.h"
#include "modeler/mesh/edit.h"
#include "tests/pipeline/crisp_model.h"

namespace sgm::pipeline {
namespace {

std::string houseText(double turn_deg) {
    return fmt::format(
        "grammar 2\nterminal wall color #c0a080\nterminal trim color #a04030\n"
        "start S -> size (8m, 5m, 6m) turn {}deg move (3m, 0, 1m) House\n"
        "rule House -> wall + trim size (102%, .3m, 102%) at +y - trim size (1m, 2m, 2m) move (1m, 0, 3m)\n",
        turn_deg);
}

double facing_deg(const std::string& text) {
    Context context;
    return derive::facingOf(modelOf(text, context).derivation) * 180 / pi;
}

TEST(Turned, FacingIsThatOfMostWalls) {
    EXPECT_EQ(facing_deg(houseText(0)), 0);
    EXPECT_EQ(facing_deg(houseText(90)), 0);
    EXPECT_NEAR(facing_deg(houseText(30)), 30, 1e-9);
    EXPECT_NEAR(facing_deg(houseText(110)), 20, 1e-9);
    EXPECT_NEAR(facing_deg(houseText(-200)), -20, 1e-9);
    const std::string block = "grammar 2\nterminal a\nstart S -> size (10m, 4m, 10m) B\n";
    // A square that is turned within its scope, and an octagon, of which no direction has more than half.
    EXPECT_NEAR(facing_deg(block + "rule B -> footprint outline((50%, 0%), (100%, 50%), (50%, 100%), (0%, 50%)) a\n"),
                45, 1e-4);
    EXPECT_EQ(facing_deg(block + "rule B -> footprint ngon(8) a\n"), 0);
    EXPECT_EQ(facing_deg(block + "rule B -> a + a turn 30deg move (20m, 0, 0)\n"), 0);
}

TEST(Turned, MeshIsThatOfTheStraightModel) {
    Context context{nullptr, 2};
    CrispModel turned = crispModel(houseText(25), 48, context);
    const Model straight = modelOf(houseText(0), context);
    const mesh::Grid grid =
        gridOver(straight, {.cell_m = static_cast<double>(turned.grid.cell_m)}, mesh::Surface::Crisp);
    auto made = makeMesh(straight, grid, {.surface = mesh::Surface::Crisp}, context);
    ASSERT_TRUE(made.ok());
    mesh::rotate(made->mesh, Mat3::rotation({0, 1, 0}, 25 * pi / 180));
    ASSERT_EQ(turned.mesh.triangleCount(), made->mesh.triangleCount());
    ASSERT_EQ(turned.mesh.chunks.size(), made->mesh.chunks.size());
    // The start's place isn't turned with it.
    const Vec3f shift = turned.mesh.chunks[0].positions[0] - made->mesh.chunks[0].positions[0];
    float farthest = 0;
    for (size_t c = 0; c < made->mesh.chunks.size(); ++c) {
        const mesh::Chunk &a = turned.mesh.chunks[c], &b = made->mesh.chunks[c];
        ASSERT_EQ(a.positions.size(), b.positions.size());
        for (size_t i = 0; i < a.positions.size(); ++i)
            farthest = std::max(farthest, length(a.positions[i] - b.positions[i] - shift));
    }
    EXPECT_LT(farthest, 1e-4f);
}

/// The mesh of the turned model names parts by their numbers.
TEST(Turned, PartsHaveTheSameNumbers) {
    for (const auto& file : std::filesystem::directory_iterator("examples/buildings")) {
        if (file.path().extension() != ".sgm") continue;
        SCOPED_TRACE(file.path().filename());
        syntax::Diagnostics problems;
        const auto grammar = load(file.path(), fileText(file.path()), problems);
        ASSERT_TRUE(grammar);
        Context context{nullptr, 2};
        const auto model = makeModel(grammar, *optionsFor(*grammar, {}), context);
        ASSERT_TRUE(model.ok());
        const auto turned = makeModel(derive::turned(model->derivation, .4), context);
        ASSERT_TRUE(turned.ok());
        EXPECT_EQ(turned->lowered->shapeOf, model->lowered->shapeOf);
    }
}

/// On the grid of the model as it stands.
MeshedModel meshedAs(const Model& model, mesh::Surface surface) {
    Context context{nullptr, 2};
    auto made = makeMesh(model, gridOf(model, 32), {.surface = surface}, context);
    EXPECT_TRUE(made.ok());
    return std::move(*made);
}

TEST(Turned, MarchingCubesAndWhatKeepsItsAxesStandAlongTheGrid) {
    Context context;
    const Model model = modelOf(houseText(25), context);
    EXPECT_TRUE(meshedAs(model, mesh::Surface::Crisp).blocks.empty());
    EXPECT_FALSE(meshedAs(model, mesh::Surface::Cubes).blocks.empty());
    EXPECT_FALSE(meshedAs(acrossGrid(model), mesh::Surface::Crisp).blocks.empty());
}

TEST(Turned, LevelSetStandsAlongTheGrid) {
    if (!isBuiltWith(Package::OpenVdb)) GTEST_SKIP() << "built without OpenVDB";
    Context context;
    const Model model = modelOf(houseText(25), context);
    const auto turned = levelSet(model, meshedAs(model, mesh::Surface::Crisp), context);
    const auto straight = levelSet(model, meshedAs(model, mesh::Surface::Cubes), context);
    ASSERT_TRUE(turned.ok() && straight.ok());
    EXPECT_EQ(turned->bounds().lo, straight->bounds().lo);
    EXPECT_EQ(turned->bounds().hi, straight->bounds().hi);
    EXPECT_EQ(turned->activeVoxels(), straight->activeVoxels());
}

}  // namespace
}  // namespace sgm::pipeline
