// What warnings say of parts thinner than a cell.
#include <gtest/gtest.h>

#include "grammar/pipeline/missing.h"
#include "modeler/mesh/validate.h"
#include "tests/pipeline/crisp_model.h"

namespace sgm::pipeline {
namespace {

/// A model's mesh as it comes from makeMesh, and what is said of it.
struct Warned {
    Model model;
    MeshedModel made;
    std::vector<MeshWarning> warnings;
};

Warned warned(const std::string& text, int resolution, int halvings = 3) {
    Context context{nullptr, 2};
    Model model = modelOf("grammar 2\n" + text, context);
    MeshedModel made = meshed(model, resolution, halvings);
    const auto missing = findMissingParts(model, made, 2, nullptr);
    EXPECT_TRUE(missing.ok());
    auto warnings = missingWarnings(model, made.grid, *missing);
    return {std::move(model), std::move(made), std::move(warnings)};
}

/// Cells that hold the roof are there at 110 and 180; at 128 they would have more than a million triangles.
TEST(ThinWarnings, SayThatHalvingEndsAtTheBoundOfTriangles) {
    const Warned roof = warned(
        "start A -> footprint rect(90, 70) extrude 6m H\n"
        "rule H -> shellBlock(.3m, .3m) + shedRoof(20deg, overhang: .6m, cover: .3m) at +y\n",
        128);
    ASSERT_FALSE(roof.warnings.empty());
    for (const MeshWarning& w : roof.warnings)
        EXPECT_NE(w.text.find("for halving them often enough takes too many triangles: --resolution "),
                  std::string::npos)
            << w.text;
}

TEST(ThinWarnings, DontSpeakOfTheBoundWhereHalvingIsOver) {
    const Warned rod = warned("start A -> cube size 8m + cube size (.02m, 4m, .02m) at +y\n", 24);
    ASSERT_EQ(rod.warnings.size(), 1u);
    EXPECT_EQ(rod.warnings[0].text.find("triangles"), std::string::npos) << rod.warnings[0].text;
}

/// A wall with openings of which the mesh has most, but torn.
TEST(ThinWarnings, NameWhatStaysTornAtTheBoundOfTriangles) {
    const Warned wall = warned(
        "start A -> size (300, 90, .6) turn 25deg split y { { ~9m: Row }* }\n"
        "rule Row -> cube - Holes\n"
        "rule Holes -> split x { { ~6m: Hole }* }\nrule Hole -> cube size (4m, 7m, 300%)\n",
        240);
    ASSERT_FALSE(wall.warnings.empty());
    EXPECT_NE(wall.warnings[0].text.find("takes too many triangles"), std::string::npos) << wall.warnings[0].text;
}

}  // namespace
}  // namespace sgm::pipeline
