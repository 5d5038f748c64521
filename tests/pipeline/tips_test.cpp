// Tips that end thinner than a cell: cones, pyramids, steep roofs and hollows.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "modeler/mesh/validate.h"
#include "tests/pipeline/crisp_model.h"

namespace sgm::pipeline {
namespace {

/// A model over a plate of 20 × 20 m, or in it, whose tip lies at `apex` moved by X and X along x and z.
struct TipCase {
    const char* name;
    const char* text;
    Vec3d apex;
};

/// How far the nearest vertex is from `apex`, metres.
double distanceTo(const mesh::Mesh& mesh, Vec3d apex) {
    double least = 1e9;
    for (const mesh::Chunk& chunk : mesh.chunks)
        for (const Vec3f p : chunk.positions) least = std::min(least, length(p.as<double>() - apex));
    return least;
}

class Tips : public ::testing::TestWithParam<TipCase> {};

TEST_P(Tips, AreWhereTheyShouldBe) {
    const TipCase& tip = GetParam();
    for (const double shift_m : {0.0, 0.037, 0.3})
        for (const auto& [resolution, tolerance_m] : {std::pair(128, 0.0), std::pair(256, 1e-4)}) {
            std::string text = "grammar 2\nterminal solid\nstart A -> " + std::string(tip.text) + "\n";
            for (size_t at; (at = text.find('X')) != std::string::npos;)
                text.replace(at, 1, std::to_string(shift_m) + "m");
            Context context{nullptr, 2};
            CrispModel crisp = crispModel(text, resolution, context);
            const auto mesh = crisp.edit({.tolerance_m = tolerance_m}, context);
            ASSERT_TRUE(mesh.ok());
            const Vec3d apex = tip.apex + Vec3d{shift_m, 0, shift_m};
            EXPECT_LT(distanceTo(*mesh, apex), 0.02 * static_cast<double>(crisp.grid.cell_m))
                << tip.name << " moved " << shift_m << " m, resolution " << resolution;
            const auto validation = mesh::validate(*mesh);
            ASSERT_TRUE(validation.ok());
            EXPECT_TRUE(validation->closed && validation->outward && !validation->selfIntersects) << tip.name;
        }
}

INSTANTIATE_TEST_SUITE_P(
    Of, Tips,
    ::testing::Values(
        TipCase{"cone", "cube size (20m, .5m, 20m) + cone size (1.5m, 8m, 1.5m) move (X, .25m, X)", {0, 4.25, 0}},
        TipCase{"cone below a ball",
                "cube size (20m, .5m, 20m) + cone size (2m, 8m, 2m) move (X, .25m, X)"
                " + sphere size .7m move (X, 4.6m, X)",
                {0, 4.25, 0}},
        TipCase{"blunt cone", "cube size (20m, .5m, 20m) + cone size (6m, 4m, 6m) move (X, .25m, X)", {0, 2.25, 0}},
        TipCase{"pyramid", "cube size (20m, .5m, 20m) + pyramid size (1.5m, 8m, 1.5m) move (X, .25m, X)", {0, 4.25, 0}},
        TipCase{"turned pyramid",
                "cube size (20m, .5m, 20m) + pyramid size (2m, 8m, 2m) turn (0deg, 20deg, 0deg) move (X, .25m, X)",
                {0, 4.25, 0}},
        TipCase{"spire",
                "cube size (20m, .5m, 20m) + size (2m, 1m, 2m) move (X, .25m, X) footprint ngon(8, 1m) hipRoof(82deg) "
                "of solid",
                {0, 3.5270045, 0}},
        TipCase{"hollow",
                "cube size (20m, 8m, 20m) - cone size (1.5m, 5m, 1.5m) turn (180deg, 0deg, 0deg) move (X, 2m, X)",
                {0, -0.5, 0}},
        TipCase{"hanging cone",
                "cube size (20m, .5m, 20m) + cone size (1.5m, 8m, 1.5m) turn (180deg, 0deg, 0deg) move (X, -.25m, X)",
                {0, -4.25, 0}}),
    [](const auto& tip) {
        std::string name = tip.param.name;
        name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
        return name;
    });

TEST(CompleteTips, StayWhereTheirVertexWasConfined) {
    Context context{nullptr, 2};
    CrispModel crisp = crispModel(
        "grammar 2\nterminal cover\n"
        "start A -> cube size (16m, .5m, 16m) + size (1.5m, 1m, 1.5m) turn (0deg, 18.08deg, 0deg) "
        "move (0.3997m, .25m, -0.4819m) footprint ngon(6, 0.75m) hipRoof(70deg) of cover\n",
        160, context);
    const auto mesh = crisp.edit({.tolerance_m = 1e-3}, context);
    ASSERT_TRUE(mesh.ok());
    EXPECT_LT(distanceTo(*mesh, {0.3997, 1.13959, -0.4819}), 1e-4);
}

/// The vertices nearest to the apex may all lie on one side of it.
TEST(CompleteTips, OfConesOf90DegreesAreThereAsARule) {
    int complete = 0;
    for (const double height_m : {0.7, 1.0, 1.6})
        for (const double shift_m : {0.0, 0.037, 0.11, 0.3}) {
            Context context{nullptr, 2};
            CrispModel crisp =
                crispModel(fmt::format("grammar 2\nstart A -> cube size (12m, .5m, 12m) + cone size ({0}m, {1}m, {0}m) "
                                       "move ({2}m, .25m, {2}m)\n",
                                       2 * height_m, height_m, shift_m),
                           120, context);
            const auto mesh = crisp.edit({}, context);
            ASSERT_TRUE(mesh.ok());
            complete += distanceTo(*mesh, {shift_m, 0.25 + height_m / 2, shift_m}) < 0.002;
            const auto validation = mesh::validate(*mesh);
            EXPECT_TRUE(validation.ok() && validation->closed && !validation->selfIntersects) << height_m << shift_m;
        }
    EXPECT_GE(complete, 11);
}

/// A roof of four slopes whose apex reaches into cells of which no corner is inside.
TEST(CompleteTips, FlatPyramidsAreTheirFourSlopes) {
    for (const char* size : {"12m, 4m, 8m", "12m, 4.1m, 8m", "9m, 2.9m, 8m", "10.1m, 4.1m, 8m", "11m, 4.6m, 8m"})
        for (const int resolution : {64, 128}) {
            Context context{nullptr, 2};
            CrispModel crisp =
                crispModel("grammar 2\nstart A -> pyramid size (" + std::string(size) + ")\n", resolution, context);
            const auto mesh = crisp.edit({.tolerance_m = 1e-3}, context);
            ASSERT_TRUE(mesh.ok());
            EXPECT_EQ(mesh->triangleCount(), 6u) << size << " at " << resolution;
        }
}

TEST(Edits, CanBeCancelledWhileTipsAreSought) {
    Progress progress;
    Context context{&progress, 2};
    CrispModel crisp = crispModel("grammar 2\nstart A -> cone size (1.5m, 8m, 1.5m)\n", 64, context);
    progress.cancel();
    const auto mesh = crisp.edit({.tolerance_m = 0.0}, context);
    ASSERT_FALSE(mesh.ok());
    EXPECT_EQ(mesh.error().kind, Error::Kind::Cancelled);
    EXPECT_STREQ(progress.stage(), "tips");
}

}  // namespace
}  // namespace sgm::pipeline
