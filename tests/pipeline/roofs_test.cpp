// Parapets of roofs in the meshes of models: halved cells hold them, or they are named.
#include <gtest/gtest.h>

#include "grammar/pipeline/missing.h"
#include "grammar/pipeline/refining.h"
#include "modeler/mesh/validate.h"
#include "tests/pipeline/crisp_model.h"

namespace sgm::pipeline {
namespace {

MeshedModel meshed(const Model& model, int resolution, int halvings = 3) {
    Context context{nullptr, 2};
    auto made =
        makeMesh(model, gridOf(model, resolution), {.surface = mesh::Surface::Crisp, .halvings = halvings}, context);
    EXPECT_TRUE(made.ok());
    return std::move(*made);
}

Model houseWith(const std::string& roof, const std::string& turn = {}) {
    Context context{nullptr, 2};
    return modelOf("grammar 2\nstart A -> footprint rect(16, 9) extrude 4m House" + turn + "\nrule House -> cube + " +
                       roof + " at +y\n",
                   context);
}

const std::string turned = " turn (0, 25deg, 0)";

/// Cells that would have to be halved four times to hold a turned wall for certain hold this one after three.
TEST(Parapets, AreHeldAsFarAsCellsMayBeHalved) {
    const Model model = houseWith("flatRoof(.3m, .8m, .25m)", turned);
    const MeshedModel made = meshed(model, 12);
    EXPECT_NEAR(mesh::measure(made.mesh).volume_m3, 16 * 9 * 4.3 + (16 * 9 - 15.5 * 8.5) * .8, .3);
    EXPECT_TRUE(made.missing->empty());
}

/// In cells of 3 m most of it shows; what doesn't is named once, with the part.
TEST(Parapets, AreNamedOnceWhereMoreIsMissing) {
    const Model model = houseWith("flatRoof(.3m, .8m, .25m)", turned);
    const MeshedModel made = meshed(model, 6);
    EXPECT_GT(mesh::measure(made.mesh).volume_m3, 16 * 9 * 4.3 + (16 * 9 - 15.5 * 8.5) * .8 * .5);
    const auto warnings = missingWarnings(model, made.grid, *made.missing);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].text.find("a 'flatRoof' of 0.25 m is too thin"), std::string::npos) << warnings[0].text;
}

}  // namespace
}  // namespace sgm::pipeline
