// Parts thinner than a cell in the meshes of models: halved cells hold them.
#include "grammar/pipeline/refining.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <regex>

#include "grammar/pipeline/incremental.h"
#include "grammar/pipeline/missing.h"
#include "modeler/mesh/components.h"
#include "modeler/mesh/connected_components.h"
#include "modeler/mesh/validate.h"
#include "tests/mesh/mesh_bytes.h"
#include "tests/pipeline/crisp_model.h"

namespace sgm::pipeline {
namespace {

std::string sceneText(const std::string& name) { return fileText("tests/mesh/scenes/" + name + ".sgm"); }

std::vector<lower::ThinPart> missingParts(const Model& model, const MeshedModel& meshed) {
    auto found = findMissingParts(model, meshed, 2, nullptr);
    EXPECT_TRUE(found.ok());
    return std::move(*found);
}

/// Mullions, finials, railings and lamp posts of a fifth of a cell and more.
TEST(Refining, ThinPartsOfTheTestScenesAreThere) {
    for (const char* name : {"mullions", "finials", "lamps"}) {
        Context context{nullptr, 2};
        const Model model = modelOf(sceneText(name), context);
        const MeshedModel coarse = meshed(model, 128, 0), fine = meshed(model, 128, 3);
        EXPECT_FALSE(missingParts(model, coarse).empty()) << name;
        EXPECT_TRUE(fine.missing->empty()) << name << ' ' << fine.missing->size();
        const auto word = mesh::validate(fine.mesh);
        EXPECT_TRUE(word.ok() && word->closed && word->outward && !word->selfIntersects) << name;
    }
}

/// Two of 4,164 halved cells didn't fit those beside them: all cells that they were connected with stayed as they were,
/// and five bars of windows were missing. The cells beside them are halved too.
TEST(Refining, CellsThatDontFitTakeTheirNeighboursWithThem) {
    const std::string text = fileText("examples/buildings/warehouse.sgm");
    Context context{nullptr, 2};
    const Model model = modelOf(std::regex_replace(text, std::regex(" texture [^\n]*"), ""), context);
    EXPECT_TRUE(meshedInPart(model, 64).missing->empty());
}

/// A ring and a rod about as thick as a cell: the mesh had some of each everywhere, but torn.
TEST(Refining, RoundPartsAndBarsAreWhole) {
    Context context{nullptr, 2};
    const Model model = modelOf(
        "grammar 2\n"
        "start S -> cube size (60, 2, 60) + F size (.9m, 3m, .9m) at +y\n"
        "rule F -> cube size (20%, 100%, 20%) + sphere size (.45m) move (0, .2m, 0)\n"
        "          + torus(.2) turn (90deg, 0deg, 0deg) size (.9m, .2m, .9m) move (0, 1.2m, 0)\n",
        context);
    const auto torn = [&](const MeshedModel& made) {
        return lower::findTornParts(model.derivation, *model.lowered, model.tape, made.mesh, made.grid.cell_m, 2,
                                    nullptr)
            ->size();
    };
    for (const int resolution : {200, 256, 300}) {
        EXPECT_GT(torn(meshed(model, resolution, 0)), 0u) << resolution;
        EXPECT_EQ(torn(meshed(model, resolution, 3)), 0u) << resolution;
    }
}

/// Bars within the scope of a thicker part show after one halving more.
TEST(Refining, CellsAreHalvedAgainWhereThePartIsThinnerThanItsScope) {
    Context context{nullptr, 2};
    const Model model = modelOf(
        "grammar 2\n"
        "start A -> cube size (8m, 1m, 8m) + cube size (4m, 3m, .2m) at +y - Holes size (100%, 100%, 200%) move (0, "
        "2m, 0)\n"
        "rule Holes -> size (4m, 3m, .4m) split x { .1m: nil | { ~1: cube | .1m: nil }* }\n",
        context);
    const MeshedModel coarse = meshed(model, 32, 1), fine = meshed(model, 32, 3);
    EXPECT_FALSE(missingParts(model, coarse).empty());
    EXPECT_TRUE(fine.missing->empty());
}

/// Six boxes of 5.53 m in all, 10 cm apart.
const std::string row =
    "rule Row -> split x { .7m: cube | .1m: nil | .87m: cube | .1m: nil | .93m: cube | .1m: nil | .61m: cube | .1m: "
    "nil "
    "| .79m: cube | .1m: nil | ~1: cube }\n";

/// Cells of 25 cm lack some of what is 10 cm thick, and halved ones have all. Returns the warnings for the former.
std::vector<MeshWarning> expectHeld(const std::string& start, lower::ThinPart::Kind kind, double volume_m3) {
    Context context{nullptr, 2};
    const Model model = modelOf("grammar 2\n" + start + row, context);
    const MeshedModel coarse = meshed(model, 32, 0), fine = meshed(model, 32, 3);
    const auto missing = missingParts(model, coarse);
    EXPECT_FALSE(missing.empty());
    for (const lower::ThinPart& m : missing) {
        EXPECT_EQ(m.kind, kind);
        EXPECT_NEAR(m.thickness_m, .1, .02);
    }
    EXPECT_TRUE(fine.missing->empty());
    EXPECT_NEAR(mesh::measure(fine.mesh).volume_m3, volume_m3, .01);
    const auto word = mesh::validate(fine.mesh);
    EXPECT_TRUE(word.ok() && word->closed && word->outward && !word->selfIntersects);
    return missingWarnings(model, coarse.grid, missing);
}

/// The roof as a whole is thinner than a cell, and halved cells hold that, but not yet its parapet.
TEST(Refining, AParapetOnARoofThatIsThinAsAWholeIsThere) {
    Context context{nullptr, 2};
    const Model model = modelOf(
        "grammar 2\nstart A -> footprint rect(16, 9) extrude 4m House\nrule House -> cube + flatRoof(.3m, .8m, .25m) "
        "at +y\n",
        context);
    const MeshedModel fine = meshed(model, 12, 3);
    EXPECT_TRUE(fine.missing->empty());
    EXPECT_NEAR(mesh::measure(fine.mesh).volume_m3, 16 * 9 * 4.3 + (16 * 9 - 15.5 * 8.5) * .8, .3);
}

TEST(Refining, WarnsWhereSinglePrecisionHasNoCellsThatHoldAPart) {
    Context context{nullptr, 2};
    const Model model = modelOf("grammar 2\nstart A -> cube size (8m, 8m, .1m) move (3000m, 0m, 0m)\n", context);
    const MeshedModel made = meshed(model, 16, 3);
    const auto warnings = missingWarnings(model, made.grid, missingParts(model, made));
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].text.find("nearer to the origin than 810 m: single precision can't hold such cells 3004 m"),
              std::string::npos)
        << warnings[0].text;
}

/// The bars of a window are what its lights leave: no part is thin.
TEST(Refining, WallsThatCutsLeaveAreThere) {
    const auto warnings = expectHeld("start A -> cube size (8m, 8m, .6m) - Row size (6.03m, 6m, 200%)\n",
                                     lower::ThinPart::Kind::Wall, .6 * (64 - 5.53 * 6));
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].text.find("walls of 0.1 m at 6 faces of 'cube'"), std::string::npos) << warnings[0].text;
}

/// Lines a few metres apart find the walls; the cells between grow from there.
TEST(Refining, LongWallsAreThereInCellsOfAnySize) {
    Context context{nullptr, 2};
    const Model model = modelOf(
        "grammar 2\nstart A -> size (34m, 8m, 26m) H\n"
        "rule H -> cube - cube size (100% - .2m, 120%, 100% - .2m)\n",
        context);
    for (const int resolution : {80, 96, 112, 128}) {
        const MeshedModel made = meshed(model, resolution, 3);
        EXPECT_TRUE(made.missing->empty()) << resolution;
        EXPECT_NEAR(mesh::measure(made.mesh).volume_m3, 8 * (34 * 26 - 33.8 * 25.8), .01) << resolution;
    }
}

TEST(Refining, NarrowGapsBetweenPartsAreThere) {
    expectHeld("start A -> cube size (8m, 1m, 3m) + Row size (6.03m, 6m, 1m) at +y\n", lower::ThinPart::Kind::Gap,
               24 + 5.53 * 6);
}

/// Strips of bars that stand out of the panes between them are nearer to what the mesh has of the bars than half a
/// cell.
TEST(Refining, BarsBetweenPanesStandOutOfThem) {
    Context context{nullptr, 2};
    const Model model = modelOf(
        "grammar 2\nterminal glass\nterminal frame\n"
        "start Wall -> size (36, 1.6, .4) split x { { ~1.5m: Pane }* }\n"
        "rule Pane -> split x { ~1: glass size (100%, 100%, 25%) | .08m: frame size (100%, 100%, 50%) }\n",
        context);
    for (const int resolution : {128, 256}) {
        const MeshedModel made = meshed(model, resolution, 3);
        EXPECT_TRUE(made.missing->empty()) << resolution;
        EXPECT_NEAR(mesh::measure(made.mesh).volume_m3, 24 * 1.6 * (1.42 * .1 + .08 * .2), .003) << resolution;
    }
}

/// Where bars cross, and where a pane holds one, less of them is free, and nothing is missing.
TEST(Refining, BarsAndPanesThatCrossLackNothing) {
    const std::pair<const char*, double> cases[] = {
        {"cube size (6, 2.4, .2) + cube size (6, 2.4, .4) move (0, 0, -.3m) + cube size (.06m, 1.2m, .12m) move (0, 0, "
         "-.04m) + cube size (1.2m, .06m, .12m) move (0, 0, -.04m)",
         .1},
        {"cube size (3, 1.6, .1) + cube size (.08, 1.6, .2) move (.5m, 0, 0)", .15},
        // A strip of 1 cm of a plate of 90 reaches into a post.
        {"cube size (9, 12, 1) + cube size (.9m, 6m, .02m) move (.55m, 0, 1m) + cube size (.22m, 6m, 1m) move (0, 0, "
         ".6m)",
         .09375}};
    for (const auto& [text, cell_m] : cases) {
        Context context{nullptr, 2};
        const Model model = modelOf("grammar 2\nstart W -> " + std::string(text) + "\n", context);
        const double longest_m = double{maxComponent(model.lowered->field.bounds.size())};
        EXPECT_TRUE(meshed(model, static_cast<int>(longest_m / cell_m), 3).missing->empty()) << text;
    }
}

/// In the seam of parts that touch the field is 0 again, which was a gap of a thousandth of a cell.
TEST(Refining, SeamsOfPartsThatTouchAreNoGaps) {
    Context context{nullptr, 2};
    const Model model = modelOf(
        "grammar 2\nterminal wall\nterminal glass\n"
        "start School -> footprint tee(36, 22, 10, 10) extrude 7.2m Mass\n"
        "rule Mass -> nil + Walls + wall size (6m, 1m, 6m) move (15.5m, 6.1m, 1.5m)\n"
        "  + wall size (5m, .25m, 3m) move (-3m, -.725m, .5m)\n"
        "rule Walls -> faces .4m { side: Facade | rest: nil }\n"
        "rule Facade -> split y { { ~3.6m: Ribbon }* }\n"
        "rule Ribbon -> split y { .9m: wall | 1.6m: Band | ~1: wall }\n"
        "rule Band -> split x { .6m: wall | ~1: glass size (100%, 100%, 25%) | .6m: wall }\n",
        context);
    const MeshedModel made = meshed(model, 128, 3);
    for (const lower::ThinPart& part : *made.missing) EXPECT_GT(part.thickness_m, .001);
}

/// Between a frieze and eaves, where some of the lines that find the gap were three spacings apart; beside a bar that
/// runs through a house and shows for .6 m in two niches of its court.
TEST(Refining, GapsBesideFacesThatShowInStripsAreThere) {
    struct Case {
        const char* text;
        double volume_m3;
    };
    const Case cases[] = {{"cube size (22m, 6.2m, 8m) + cube size (22m, .5m, 8.24m) move (0, 2.75m, 0)\n"
                           "  + cube size (25m, .25m, 11m) move (0, 3.175m, 0)",
                           22 * 6.15 * 8 + 22 * .24 * .5 + 25 * .25 * 11},
                          {"cube size (34m, 5m, 30m) - cube size (1.6621m, 3m, 16.2m) move (6.256m, 0, 0)\n"
                           "  + cube size (.14m, 3m, 29m) move (6.9511m, 0, 0) - cube size (17m, 6m, 15m)",
                           34 * 5 * 30 - 17 * 5 * 15 - 2 * .6 * 3 * (1.6621 - .14)}};
    for (const Case& c : cases)
        for (const int resolution : {192, 256}) {
            Context context{nullptr, 2};
            const Model model = modelOf("grammar 2\nstart A -> " + std::string(c.text) + "\n", context);
            const MeshedModel made = meshed(model, resolution, 3);
            EXPECT_TRUE(made.missing->empty()) << c.text;
            EXPECT_NEAR(mesh::measure(made.mesh).volume_m3 / c.volume_m3, 1, 5e-6) << resolution << ' ' << c.text;
        }
}

/// Half a cell wide and no deeper, so that the rims are near what is missing: it was filled at 64, 76 and 84.
TEST(Refining, GroovesAsShallowAsWideAreThere) {
    Context context{nullptr, 2};
    const Model model = modelOf(
        "grammar 2\nstart A -> cube size (22m, 5m, 10m) + cube size (22.24m, 2m, 10.24m) move (0, -1.5m, 0)\n"
        "  + cube size (25m, .25m, 13m) move (0, -.239m, 0)\n",
        context);
    const double volume_m3 = 22 * 10 * (5 - 2 - .25) + 22.24 * 10.24 * 2 + 25 * 13 * .25;
    for (const int resolution : {64, 70, 76, 80, 84, 92, 100}) {
        const MeshedModel made = meshed(model, resolution, 3);
        EXPECT_TRUE(made.missing->empty()) << resolution;
        EXPECT_NEAR(mesh::measure(made.mesh).volume_m3 / volume_m3, 1, 1e-5) << resolution;
    }
}

/// A cylinder runs through a block and stands 12 cm out of it around a niche, as a ring of 20 cm: some of it was
/// missing in cells of 30 cm, without a word.
TEST(Refining, RimsOfRoundNichesAreWhole) {
    Context context{nullptr, 2};
    const Model model = modelOf(
        "grammar 2\nstart A -> cube size (8m, 4m, 12m) + cylinder size (2.4m, 12.24m, 2.4m) turn (90deg, 0, 0)\n"
        "  - cylinder size (2m, 1.6m, 2m) turn (90deg, 0, 0) move (0, 0, 6m)\n",
        context);
    const double pi = std::numbers::pi, rim_m3 = pi * .12 * (1.44 - 1);
    const double block_m3 = 8 * 4 * 12 - pi * .8 + pi * .12 * 1.44;  // with the other end of the cylinder
    for (const int resolution : {32, 36, 38, 40, 42, 44, 46, 48}) {
        MeshedModel made = meshed(model, resolution, 3);
        const auto mesh =
            edited(std::move(made.mesh), {}, {model.tape, mesh::Surface::Crisp, made.grid.cell_m}, context);
        EXPECT_NEAR((mesh::measure(mesh.value()).volume_m3 - block_m3) / rim_m3, 1, .05) << resolution;
    }
}

/// The same of blocks that run through a house and stand out around its windows: 2 m³ of them were missing.
TEST(Refining, RimsOfBlocksAreWhole) {
    Context context{nullptr, 2};
    const std::string text = fileText("examples/buildings/hall.sgm");
    const Model model = modelOf(std::regex_replace(text, std::regex("peak = 1"), "peak = 0"), context);
    EXPECT_NEAR(mesh::measure(meshed(model, 128, 3).mesh).volume_m3, 14276.3, 1);  // by exact solid geometry
}

/// A shell over an oblique plan, a tube and a roof that is open below, all of 10 cm, in cells of 13 to 16 cm.
TEST(Refining, WallsOfAnyPlanAndSlopeAreThere) {
    struct Case {
        const char* text;
        int resolution;
        double volume_m3;
    };
    const double rise = 5 * std::tan(35 * M_PI / 180), hollow = 1 - .1 / (5 * std::sin(35 * M_PI / 180));
    const Case cases[] = {
        {"start A -> footprint outline((0, 0), (30, 4), (34, 26), (-3, 20)) extrude 8m V\n"
         "rule V -> shellBlock(.1m, 0m)\n",
         256, 8 * 10.9922},
        {"start A -> size (10m, 20m, 10m) T\nrule T -> cylinder - cylinder size (100% - .2m, 120%, 100% - .2m)\n", 128,
         M_PI * 20 * (25 - 4.9 * 4.9)},
        {"start A -> size (10m, 10m, 12m) gableRoof(35deg, cover: .1m)\n", 96, 12 * 5 * rise * (1 - hollow * hollow)}};
    for (const Case& c : cases) {
        Context context{nullptr, 2};
        const Model model = modelOf("grammar 2\n" + std::string(c.text), context);
        const MeshedModel made = meshed(model, c.resolution, 3);
        EXPECT_TRUE(made.missing->empty()) << c.text;
        const auto figures = mesh::measure(made.mesh);
        EXPECT_NEAR(figures.volume_m3, c.volume_m3, .004 * c.volume_m3) << c.text;
        EXPECT_EQ(mesh::connectedComponents(made.mesh, 0).size(), 1u) << c.text;
    }
}

/// Neither are they free, nor are they missing as a whole: up to an eighth of them was missing without a word.
TEST(Refining, TurnedWallsWithOpeningsAreWholeOrNamed) {
    for (const int resolution : {40, 64, 96})
        for (int degrees = 0; degrees <= 90; degrees += 5) {
            Context context{nullptr, 2};
            const std::string text = "grammar 2\nstart A -> size (30, 4.5, .6) turn " + std::to_string(degrees) +
                                     "deg Arcade\n"
                                     "rule Arcade -> split x { { ~3m: Arch }* }\n"
                                     "rule Arch -> cube - cube size (2m, 4m, 300%) move (0, -.25m, 0)\n";
            const Model model = acrossGrid(modelOf(text, context));
            MeshedModel made = meshed(model, resolution, 3);
            if (!made.missing->empty()) continue;
            const auto whole =
                edited(std::move(made.mesh), {}, {model.tape, mesh::Surface::Crisp, made.grid.cell_m}, context);
            ASSERT_TRUE(whole.ok());
            EXPECT_NEAR(mesh::measure(*whole).volume_m3 / 33, 1, .02) << degrees << ' ' << resolution;
        }
}

/// What such a slab lacked were strips a cell wide, and its end, too little to be told by lines through it.
TEST(Refining, TurnedSlabsOfAboutACellAreWhole) {
    for (const double degrees : {5, 9, 20, 30})
        for (const double thickness_m : {.3, .36, .4, .42, .45}) {
            Context context{nullptr, 2};
            const Model model = modelOf("grammar 2\nstart A -> cube size (18, " + std::to_string(thickness_m) +
                                            "m, 17) turn (0deg, 0deg, " + std::to_string(degrees) + "deg)\n",
                                        context);
            const MeshedModel made = meshed(model, 44, 3);
            EXPECT_TRUE(made.missing->empty()) << degrees << ' ' << thickness_m;
            EXPECT_NEAR(mesh::measure(made.mesh).volume_m3 / (18 * 17 * thickness_m), 1, 1e-3)
                << degrees << ' ' << thickness_m;
        }
}

TEST(Refining, LongSlopesAndEavesAreWhole) {
    struct Case {
        const char* text;
        double volume_m3, depth_m;  ///< depth: along z
    };
    const Case cases[] = {
        {"start A -> footprint rect(48, 14) extrude 5m H\n"
         "rule H -> shellBlock(.4m, .3m) + gableRoof(38deg, overhang: .6m, cover: .3m) at +y\n",
         698.9, 15.2},
        {"start A -> footprint rect(40, 30) extrude 6m H\n"
         "rule H -> shellBlock(.3m, .3m) + shedRoof(20deg, overhang: .6m, cover: .3m) at +y\n",
         999.3, 31.2},
    };
    for (const Case& c : cases)
        for (const int resolution : {64, 110, 128}) {
            Context context{nullptr, 2};
            const Model model = modelOf("grammar 2\n" + std::string(c.text), context);
            const MeshedModel made = meshedInPart(model, resolution);
            EXPECT_TRUE(made.missing->empty()) << c.text << resolution;
            const auto figures = mesh::measure(made.mesh);
            EXPECT_NEAR(figures.volume_m3, c.volume_m3, .002 * c.volume_m3) << c.text << resolution;
            EXPECT_NEAR(static_cast<double>(figures.bounds.size().z), c.depth_m, .2) << c.text << resolution;
        }
}

TEST(Refining, WhatIsTooThinEvenForHalvedCellsIsNamed) {
    Context context{nullptr, 2};
    const Model model = modelOf("grammar 2\nstart A -> cube size 8m + cube size (.02m, 4m, .02m) at +y\n", context);
    const MeshedModel made = meshed(model, 24, 3);
    ASSERT_EQ(made.missing->size(), 1u);
    EXPECT_NEAR((*made.missing)[0].thickness_m, .02, 1e-6);
}

TEST(Refining, FollowedStepsGiveTheBytesOfAWholeBuild) {
    const std::string text =
        "grammar 2\nparam w = .1m in .02m..1m\n"
        "start A -> cube size 4m + cube size (w, 2m, w) at +y + cube size (3m, .06m, 3m) at -y\n";
    syntax::Diagnostics problems;
    const auto grammar = load("test.sgm", text, problems);
    ASSERT_TRUE(grammar);
    IncrementalPipeline followed({.surface = mesh::Surface::Crisp, .threads = 2});
    for (const char* width : {"w=10cm", "w=7cm", "w=12cm"}) {
        ModelChoice choice;
        choice.settings = {width};
        const auto options = optionsFor(*grammar, choice);
        ASSERT_TRUE(options.ok());
        Context context{nullptr, 2};
        ASSERT_TRUE(followed.to(grammar, *options, context).ok());
        const Model model = modelOf(text, context);
        const mesh::Grid grid = gridOf(model, 32);
        const auto step = followed.meshed(grid, context);
        const auto all =
            makeMesh(*makeModel(grammar, *options, context), grid, {.surface = mesh::Surface::Crisp}, context);
        ASSERT_TRUE(step.ok() && all.ok());
        EXPECT_EQ(mesh::bytesOf(step->mesh), mesh::bytesOf(all->mesh)) << width;
        EXPECT_EQ(step->missing->size(), all->missing->size());
    }
}

}  // namespace
}  // namespace sgm::pipeline
