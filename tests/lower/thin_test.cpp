// Parts thinner than a cell: which of them a mesh shows (tests/mesh/scenes), and what the list of lost ones is worth.
#include <array>
#include <cmath>

#include "grammar/lower/thin_parts.h"
#include "grammar/lower/thin_sections.h"
#include "grammar/rules/params.h"
#include "tests/lower/lost_parts.h"

namespace sgm {
namespace {

using namespace testing_;

mesh::Mesh meshed(const Lowered& model, int cells) {
    return meshedWith(model, mesh::cellFor(model.model->field.bounds, cells), mesh::Surface::Cubes);
}

std::vector<lower::ThinPart> missingAt(const Lowered& model, float cell_m) {
    auto found = lower::findMissingParts(model.derivation, *model.model, model.tape(),
                                         meshedWith(model, cell_m, mesh::Surface::Crisp), cell_m, 2, nullptr);
    EXPECT_TRUE(found.ok());
    return *found;
}

/// A scene with its parameters as they are, or each of those named set to so many metres.
Lowered scene(const std::string& name, const std::vector<std::string>& names = {}, double metres = 0) {
    const std::string text = fileText("tests/mesh/scenes/" + name + ".sgm");
    const auto grammar = grammarOf(text);
    derive::Options options;
    options.params = rules::valuesOf(*grammar, 0);
    for (size_t i = 0; i < grammar->params.size(); ++i)
        if (std::count(names.begin(), names.end(), grammar->params[i].name)) options.params[i].n[0] = metres;
    return Lowered(text, options);
}

class Thin : public testing::TestWithParam<std::pair<const char*, std::vector<std::string>>> {};

TEST(LostParts, AreExposedAndNotBuried) {
    const Lowered model(
        "grammar 1\nstart S -> cube size 4 + cube size 1 + cube size (6, .5, .5) + cube size .05 move (0, 2, 0)\n");
    const std::set<OriginId> exposed = exposedParts(model);
    std::vector<std::string> paths;
    for (const OriginId part : exposed) paths.push_back(model.model->provenance.parts[part].path);
    EXPECT_EQ(paths, (std::vector<std::string>{"S/cube", "S/cube/cube[2]", "S/cube/cube[3]"}));
}

/// Of a turned wall thinner than a cell the mesh shows posts, as near to each other as its cells are.
TEST(LostParts, OfATurnedWallAreTold) {
    for (const int degrees : {5, 15, 30}) {
        const Lowered model("grammar 2\nstart A -> cube size (40, 9, .3) turn " + std::to_string(degrees) +
                            "deg + cube size (70, 1, 70) move (0, -5, 0)\n");
        const std::vector<lower::ThinPart> missing = missingAt(model, 70 / 128.f);
        ASSERT_EQ(missing.size(), 1u) << degrees;
        EXPECT_GT(missing[0].missing, .25) << degrees;
        EXPECT_TRUE(missingAt(model, static_cast<float>(missing[0].cell_m)).empty()) << degrees;
    }
}

/// Two lights in a frame leave a bar of 10 cm; nothing else is thinner than a cell and a half.
TEST(ThinSections, AreTheWallsThatCutsLeave) {
    const Lowered model(
        "grammar 2\nstart A -> cube size (4, 3, .5) - cube size (1, 2, 1) move (-.55, 0, 0) - cube size (1, 2, 1) move "
        "(.55, 0, 0)\n");
    const auto found = lower::findThinSections(model.derivation, *model.model, model.tape(), .2f, 2, nullptr);
    ASSERT_TRUE(found.ok());
    ASSERT_EQ(found->size(), 2u);
    const std::array<int, 2> faces{1, 0};  // the high side of the left one, the low side of the right one
    for (size_t i = 0; i < 2; ++i) {
        const lower::ThinSection& section = (*found)[i];
        EXPECT_EQ(section.face, faces[i]);
        EXPECT_GT(section.lines.size(), 10u);
        for (const auto& line : section.lines) {
            EXPECT_NEAR(line.thickness_m, .1, 1e-3);
            EXPECT_NEAR(std::abs(line.ends[0].at.x), .05, 1e-3);
            EXPECT_EQ(line.ends[0].owner, section.part);
            EXPECT_NE(line.ends[1].owner, section.part);
        }
    }
    const std::vector<lower::ThinPart> none;
    EXPECT_TRUE(lower::findThinSections(model.derivation, *model.model, model.tape(), .2f, 2, nullptr, &none)->empty());
    EXPECT_TRUE(lower::findThinSections(model.derivation, *model.model, model.tape(), .05f, 2, nullptr)->empty());
    Progress progress;
    progress.cancel();
    EXPECT_FALSE(lower::findThinSections(model.derivation, *model.model, model.tape(), .2f, 2, &progress).ok());
}

/// The tops of two slabs below a sill are one plane, so that the gap below it belongs to neither.
TEST(ThinSections, AreGapsBesidePartsThatShareASurface) {
    const Lowered model(
        "grammar 2\nstart A -> cube size (20m, 5m, 20m) + cube size (24m, 1m, 24m) move (0, -3m, 0)\n"
        "  + cube size (24.4m, .5m, 24.4m) move (0, -2.75m, 0) + cube size (18m, .3m, 20.7m) move (0, -2.179m, 0)\n");
    const auto found = lower::findThinSections(model.derivation, *model.model, model.tape(), .35f, 2, nullptr);
    ASSERT_TRUE(found.ok());
    ASSERT_EQ(found->size(), 2u);
    const std::array<int, 2> faces{3, 2};  // up from the slabs, down from the sill
    for (size_t i = 0; i < 2; ++i) {
        const lower::ThinSection& section = (*found)[i];
        EXPECT_TRUE(section.isGap);
        EXPECT_EQ(section.face, faces[i]);
        for (const auto& line : section.lines) EXPECT_NEAR(line.thickness_m, .171, 1e-3);
    }
}

TEST_P(Thin, PartsOfTwoCellsAreAllThere) {
    const auto& [name, thin] = GetParam();
    const Lowered model = scene(name, thin, 2.0 * 40 / 128);
    for (const OriginId part : lostParts(model, meshed(model, 128))) ADD_FAILURE() << partText(model, part);
}

/// Marching cubes finds a part between its samples by chance alone; the list must know of the others.
TEST_P(Thin, PartsOfATwentiethOfACellAreListed) {
    const auto& [name, thin] = GetParam();
    const Lowered model = scene(name);
    const std::vector<OriginId> lost = lostParts(model, meshed(model, 24));
    EXPECT_GT(lost.size(), 4u);
    EXPECT_LT(lost.size(), exposedParts(model).size());
}

/// A part is lost at 128 for its thinness alone.
TEST_P(Thin, WhatIsLostAt128IsThinnerThanACell) {
    const Lowered model = scene(GetParam().first);
    const mesh::Mesh mesh = meshed(model, 128);
    const double cell_m = static_cast<double>(mesh::cellFor(model.model->field.bounds, 128));
    for (const OriginId part : lostParts(model, mesh)) {
        const derive::Shape& shape = model.derivation.tree.shapes[model.model->shapeOf[part]];
        EXPECT_LT(minComponent(shape.scope.size), cell_m) << partText(model, part);
    }
}

/// What the list says of cells that hold a part is true.
TEST_P(Thin, PartsThatTheMeshLacksAreNamedWithTheCellsThatHoldThem) {
    const Lowered model = scene(GetParam().first);
    const float cell_m = mesh::cellFor(model.model->field.bounds, 64);
    const auto missing = missingAt(model, cell_m);
    ASSERT_FALSE(missing.empty());
    double least = 1e9;
    std::set<OriginId> named;
    for (const lower::ThinPart& m : missing) {
        EXPECT_LT(m.thickness_m, static_cast<double>(cell_m));
        EXPECT_GT(m.missing, 0.1);
        least = std::min(least, m.cell_m);
        named.insert(m.part);
    }
    const mesh::Mesh mesh = meshedWith(model, cell_m, mesh::Surface::Crisp);
    for (const OriginId part : lostParts(model, mesh))
        EXPECT_TRUE(named.contains(part) || least < 0.02) << partText(model, part);
    for (const lower::ThinPart& m : missingAt(model, static_cast<float>(0.98 * least)))
        ADD_FAILURE() << partText(model, m.part) << ": " << m.missing;
}

TEST(ThinParts, BuriedAndThickOnesAreNotMissing) {
    const Lowered model(
        "grammar 1\nstart S -> cube size 4 + cube size (1, .01, 1) + cube size (6, .5, .5)\n"
        "           + cube size (2, .01, 2) at +x to centre turn (0, 0, 40deg)\n");
    const auto missing = missingAt(model, 0.2f);
    ASSERT_EQ(missing.size(), 1u);
    EXPECT_EQ(model.model->provenance.parts[missing[0].part].path, "S/cube/cube[3]");
    EXPECT_NEAR(missing[0].cell_m, 0.01 / (std::cos(40 * M_PI / 180) + std::sin(40 * M_PI / 180)), 1e-4);
}

/// Their scopes are thick.
TEST(ThinParts, ParapetsAndRoofShellsAreNamed) {
    const std::pair<const char*, double> roofs[] = {{"flatRoof(parapet: .9m, thickness: 5cm)", .05},
                                                    {"gableRoof(32deg, cover: 6cm, ends: x)", .06}};
    for (const auto& [roof, wall_m] : roofs) {
        const Lowered model("grammar 2\nstart A -> footprint rect(14, 9) extrude 4m W\nrule W -> block + " +
                            std::string(roof) + " at +y\n");
        const auto missing = missingAt(model, 0.31f);
        ASSERT_EQ(missing.size(), 1u) << roof;
        EXPECT_NEAR(missing[0].thickness_m, wall_m, 1e-3);
        EXPECT_LT(missing[0].cell_m, wall_m);
        EXPECT_TRUE(missingAt(model, static_cast<float>(missing[0].cell_m)).empty()) << roof;
    }
}

/// Walls of any plan and slope: neither their scopes nor faces of boxes tell that they are thin.
TEST(ThinWalls, OfShellsAndBesideRoundCutsAreNamed) {
    const std::pair<const char*, lower::ThinPart::Kind> models[] = {
        {"start A -> footprint outline((0, 0), (30, 4), (34, 26), (-3, 20)) extrude 8m V\nrule V -> shellBlock(.1m)\n",
         lower::ThinPart::Kind::Part},
        {"start A -> size (10m, 20m, 10m) T\nrule T -> cylinder - cylinder size (100% - .2m, 120%, 100% - .2m)\n",
         lower::ThinPart::Kind::Wall},
        {"start A -> size (9m, 9m, 9m) T\nrule T -> sphere - sphere size (100% - .2m, 100% - .2m, 100% - .2m)\n",
         lower::ThinPart::Kind::Wall}};
    for (const auto& [text, kind] : models) {
        const Lowered model("grammar 2\n" + std::string(text));
        const auto missing = missingAt(model, 0.21f);
        ASSERT_EQ(missing.size(), 1u) << text;
        EXPECT_EQ(missing[0].kind, kind) << text;
        EXPECT_NEAR(missing[0].thickness_m, .1, 2e-3) << text;
        EXPECT_GT(missing[0].missing, .1) << text;
        EXPECT_LT(missing[0].cell_m, .1) << text;
        EXPECT_TRUE(missingAt(model, static_cast<float>(missing[0].cell_m)).empty()) << text;
    }
}

/// Rock between two cavities that touch has any thickness down to none, which no cells hold.
TEST(ThinWalls, ThatTaperAreNotMissing) {
    const Lowered model(
        "grammar 2\nstart A -> size (10m, 6m, 6m) T\n"
        "rule T -> cube - sphere size 4m move (-2.02m, 0, 0) - sphere size 4m move (2.02m, 0, 0)\n");
    EXPECT_TRUE(missingAt(model, 0.2f).empty());
}

INSTANTIATE_TEST_SUITE_P(Scenes, Thin,
                         testing::Values(std::pair("mullions", std::vector<std::string>{"bars", "finial"}),
                                         std::pair("finials", std::vector<std::string>{"pole", "flag"}),
                                         std::pair("lamps", std::vector<std::string>{"post", "rail"})),
                         [](const auto& info) { return std::string(info.param.first); });

}  // namespace
}  // namespace sgm
