// Parts thinner than a cell: which of them a mesh shows (tests/mesh/scenes), and what the list of lost ones is worth.
#include "grammar/rules/params.h"
#include "modeler/mesh/polygonize.h"
#include "modeler/mesh/subdivide.h"
#include "tests/lower/lost_parts.h"

namespace sgm {
namespace {

using namespace testing_;

mesh::Mesh meshed(const Lowered& model, int cells) {
    const Box3f& bounds = model.model->field.bounds;
    const mesh::Grid grid = mesh::gridFor(bounds, mesh::cellFor(bounds, cells));
    mesh::Counts counts;
    const auto blocks = mesh::subdivide(model.tape(), grid, 2, nullptr, counts);
    return *mesh::polygonize(*blocks, grid, {.threads = 2}, nullptr, counts);
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

INSTANTIATE_TEST_SUITE_P(Scenes, Thin,
                         testing::Values(std::pair("mullions", std::vector<std::string>{"bars", "finial"}),
                                         std::pair("finials", std::vector<std::string>{"pole", "flag"}),
                                         std::pair("lamps", std::vector<std::string>{"post", "rail"})),
                         [](const auto& info) { return std::string(info.param.first); });

}  // namespace
}  // namespace sgm
