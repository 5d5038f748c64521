// What warnings say of parts thinner than a cell.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>

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

Warned warned(const std::string& text, int resolution, int halvings = 3,
              size_t triangles = mesh::PolygonizeOptions{}.halvedTriangles, bool halvesAll = true) {
    Context context{nullptr, 2};
    Model model = acrossGrid(modelOf("grammar 2\n" + text, context));
    MeshedModel made = meshed(model, resolution, halvings, triangles, halvesAll);
    const auto missing = findMissingParts(model, made, 2, nullptr);
    EXPECT_TRUE(missing.ok());
    auto warnings = missingWarnings(model, made.grid, *missing);
    return {std::move(model), std::move(made), std::move(warnings)};
}

constexpr size_t million = 1'000'000;  ///< triangles

/// At 128 cells that hold the roof would have more than a million triangles.
TEST(ThinWarnings, SayThatHalvingEndsAtTheBoundOfTriangles) {
    const Warned roof = warned(
        "start A -> footprint rect(90, 70) extrude 6m H\n"
        "rule H -> shellBlock(.3m, .3m) + shedRoof(20deg, overhang: .6m, cover: .2m) at +y\n",
        128, 3, million);
    ASSERT_FALSE(roof.warnings.empty());
    for (const MeshWarning& w : roof.warnings)
        EXPECT_NE(w.text.find("for halving them often enough takes too many triangles: --resolution "),
                  std::string::npos)
            << w.text;
}

/// The points that told how much of its faces is free missed 5 cm at each side that lie in the wall.
TEST(ThinWarnings, DontNameADoorWhoseSidesAreInItsWall) {
    const std::string text =
        "start A -> cube size (40, 1, 34) + Wall size (6m, 5m, .6m) turn 33deg move (0, 3m, 0)\n"
        "rule Wall -> cube - cube size (1.4m, 2.4m, 200%) move (0, -.9m, 0)\n"
        "  + cube size (1.5m, 2.5m, .12m) move (0, -.9m, 0)\n";
    for (const int resolution : {128, 150}) {
        const Warned door = warned(text, resolution);
        EXPECT_TRUE(door.warnings.empty()) << door.warnings[0].text;
    }
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
        240, 3, 8 * million, /*halvesAll=*/false);
    ASSERT_FALSE(wall.warnings.empty());
    EXPECT_NE(wall.warnings[0].text.find("takes too many triangles"), std::string::npos) << wall.warnings[0].text;
}

/// What stands out of a thick part has no thickness that its scope says: that of a torn strip was named, down to
/// nothing.
TEST(ThinWarnings, NameRimsWithoutAThickness) {
    const Warned wall = warned(
        "start A -> Wall size (60, 20, 10) turn 25deg\n"
        "rule Wall -> cube + row 150 along x gap .2m { cube size (100%, 100%, 10.8m) }\n",
        40, 3, 1);
    const auto isOfRim = [](const MeshWarning& w) {
        return w.text.starts_with("what shows of a 'cube' is too thin for the mesh's cells of ");
    };
    EXPECT_EQ(std::count_if(wall.warnings.begin(), wall.warnings.end(), isOfRim), 1);
}

/// The cells around the roof would have more than a million triangles, those around the rails few.
TEST(ThinWarnings, NameWhatTakesMostTrianglesAlone) {
    const Warned house = warned(
        "start A -> footprint rect(90, 70) extrude 6m H\n"
        "rule H -> block + shedRoof(20deg, overhang: .6m, cover: .2m) at +y + Rail size (60m, 2m, .12m) move (0, 0, "
        "40m)\n"
        "rule Rail -> split x { { .12m: cube | ~1m: nil }* } + cube size (100%, .12m, 100%) at +y\n",
        96, 3, million);
    ASSERT_FALSE(house.warnings.empty());
    for (const MeshWarning& w : house.warnings) EXPECT_NE(w.text.find("'shedRoof'"), std::string::npos) << w.text;
}

/// The largest resolution that warnings name.
int namedIn(const std::vector<MeshWarning>& warnings) {
    int largest = 0;
    for (const MeshWarning& w : warnings) {
        std::smatch found;
        if (std::regex_search(w.text, found, std::regex("--resolution ([0-9]+)")))
            largest = std::max(largest, std::stoi(found[1]));
    }
    return largest;
}

/// Of the mesh as it is written.
double volumeOf(Warned& of) {
    Context context{nullptr, 2};
    const auto written =
        edited(std::move(of.made.mesh), {}, {of.model.tape, mesh::Surface::Crisp, of.made.grid.cell_m}, context);
    EXPECT_TRUE(written.ok());
    return mesh::measure(*written).volume_m3;
}

/// Cells are halved three times: eight times as large as those that hold a part they are small enough. In cells twice
/// as large some of it is missing.
TEST(ThinWarnings, NameTheResolutionWhoseHalvedCellsHoldAPart) {
    struct Case {
        const char* text;
        int resolution;
        double thick_m3, thin_m3;
    };
    const double turned = 4 * 3 * .03;
    const Case cases[] = {
        {"start A -> cube size 8m + Rod move (.31m, 6m, .2m) + Rod move (-1.37m, 6m, .67m) + Rod move (2.11m, 6m, "
         "-1.93m)"
         " + Rod move (-2.593m, 6m, -1.01m)\nrule Rod -> cube size (.02m, 4m, .02m)\n",
         20, 512, 4 * .0016},
        {"start A -> cube size 8m + cube size (4m, 3m, .03m) turn 25deg at +y\n", 20, 512, turned},
        {"start A -> size (5m, 4m, 5m) T\nrule T -> cylinder - cylinder size (100% - .08m, 120%, 100% - .08m)\n", 8, 0,
         M_PI * 4 * (2.5 * 2.5 - 2.46 * 2.46)},
        {"start A -> footprint rect(16, 9) extrude 4m H\nrule H -> cube + flatRoof(.3m, .8m, .05m) at +y\n", 16,
         16 * 9 * 4.3, .8 * (16 * 9 - 15.9 * 8.9)}};
    for (const Case& c : cases) {
        const Warned coarse = warned(c.text, c.resolution);
        ASSERT_FALSE(coarse.warnings.empty()) << c.text;
        const int named = namedIn(coarse.warnings);
        EXPECT_GT(named, c.resolution) << c.text;
        const auto thinVolume = [&](int resolution) {
            Warned of = warned(c.text, resolution);
            return (volumeOf(of) - c.thick_m3) / c.thin_m3;
        };
        EXPECT_NEAR(thinVolume(named), 1, .02) << c.text << named;
        // Samples may lie in it by chance.
        EXPECT_GT(std::abs(thinVolume(named * 2 / 5) - 1) + std::abs(thinVolume(named * 9 / 20) - 1), .02)
            << c.text << named;
    }
}

TEST(ThinWarnings, NameTheResolutionWithoutHalvingWhereThatIsNotAllowed) {
    const char* const rod = "start A -> cube size 8m + cube size (.1m, 4m, .1m) at +y\n";
    const Warned coarse = warned(rod, 24, 0);
    ASSERT_EQ(coarse.warnings.size(), 1u);
    EXPECT_NEAR(namedIn(coarse.warnings), 120, 1);
    EXPECT_TRUE(warned(rod, namedIn(coarse.warnings), 0).warnings.empty());
}

/// At 128 cells 23 % of the house is missing.
TEST(ThinWarnings, NameAResolutionThatHoldsWhatTheBoundOfTrianglesEnds) {
    const char* const shed =
        "start A -> footprint rect(90, 70) extrude 6m H\n"
        "rule H -> shellBlock(.3m, .3m) + shedRoof(20deg, overhang: .6m, cover: .2m) at +y\n";
    const int named = namedIn(warned(shed, 128, 3, million).warnings);
    EXPECT_GT(named, 128);
    EXPECT_LT(named, 300);
    Warned held = warned(shed, named, 3, million);
    EXPECT_NEAR(volumeOf(held) / 3806.6, 1, .002) << named;
}

TEST(ThinWarnings, TellWhatLacksMostFirst) {
    std::string text = "start A -> cube size 8m + Rod0 + Rod1 + Rod2 + Rod3 + Rod4 + Rod5 + Plate\n";
    for (int k = 0; k < 6; ++k)
        text += "rule Rod" + std::to_string(k) + " -> cube size (.02m, 1m, .02m) move (" + std::to_string(k) +
                "m - 2.7m, 4.5m, .21m)\n";
    text += "rule Plate -> cube size (5m, 3m, .02m) move (0m, 5.5m, 1.21m)\n";
    const Warned all = warned(text, 24, 0);
    ASSERT_EQ(all.warnings.size(), 6u);
    EXPECT_EQ(all.warnings[0].place, "test.sgm:9: ") << all.warnings[0].text;
    for (size_t i = 1; i < 5; ++i) EXPECT_EQ(all.warnings[i].place, "test.sgm:" + std::to_string(2 + i) + ": ");
    EXPECT_EQ(all.warnings[5].text, "parts of 2 more lines are too thin for these cells");
}

/// One line that floats in many pieces doesn't hide the others.
TEST(FloatingWarnings, AreOfLinesNotOfPieces) {
    Context context{nullptr, 2};
    const Model model = modelOf(
        "grammar 2\nstart A -> cube size (40, 1, 40) + Balls + cube size .9m move (0, 9m, 0)\n"
        "rule Balls -> for k in 0..11 { + cube size 1m move (3 * k - 16, 4m, 0) }\n",
        context);
    const MeshedModel made = meshed(model, 80);
    const auto warnings = meshWarnings(model, made, context);
    ASSERT_TRUE(warnings.ok());
    ASSERT_EQ(warnings->size(), 2u);
    EXPECT_NE((*warnings)[0].text.find("floats: 1 m³"), std::string::npos) << (*warnings)[0].text;
    EXPECT_NE((*warnings)[0].text.find("; 11 more pieces of this line, 11 m³ in all, float too"), std::string::npos)
        << (*warnings)[0].text;
    EXPECT_NE((*warnings)[1].text.find("floats: 0.729 m³"), std::string::npos) << (*warnings)[1].text;
    EXPECT_EQ((*warnings)[1].text.find("more"), std::string::npos) << (*warnings)[1].text;
}

}  // namespace
}  // namespace sgm::pipeline
