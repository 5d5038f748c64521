// Pictures that cover surfaces: what the language says of them, and what materials become.
#include <gtest/gtest.h>

#include "modeler/image/texture_frame.h"
#include "tests/image/pictures.h"
#include "tests/lower/lowered.h"
#include "tests/operations/loaded.h"

namespace sgm::testing_ {
namespace {

image::ImageFilePtr picture(const std::string& name, uint32_t width, uint32_t height) {
    auto file =
        image::readImageBytes(image::pngOf(width, height, std::vector<uint8_t>(3 * size_t{width} * height, 99)));
    auto named = std::make_shared<image::ImageFile>(**file);
    named->path = "/pictures/" + name;
    return named;
}

/// A grammar that may read brick.png (2 x 1 pixels), bump.png and rough.png; its errors as text.
std::shared_ptr<const rules::Grammar> textured(const std::string& text, std::string* errors = nullptr) {
    rules::Loader loader;
    loader.image = [](const std::string& name, const syntax::Source&, std::string& why) -> image::ImageFilePtr {
        if (name == "brick.png") return picture(name, 2, 1);
        if (name == "bump.png" || name == "rough.png") return picture(name, 1, 1);
        why = "No such file or directory";
        return nullptr;
    };
    return loaded(loader, text, errors);
}

struct Covered {
    derive::Derivation derivation;
    std::unique_ptr<lower::Model> model;
    explicit Covered(const std::string& text) {
        auto d = derive::derive(textured(text), {}, nullptr);
        EXPECT_TRUE(d.ok()) << (d.ok() ? "" : d.error().message);
        derivation = std::move(*d);
        auto made = lower::lower(derivation, nullptr);
        EXPECT_TRUE(made.ok());
        model = std::move(*made);
    }
    const Material& material(const std::string& symbol) const {
        for (const Part& part : model->provenance.parts)
            if (part.symbol() == symbol) return model->provenance.materials[part.material];
        ADD_FAILURE() << "no part is called " << symbol;
        return model->provenance.materials[0];
    }
};

TEST(Textures, CoverAMaterialInMetres) {
    const Covered c(
        "grammar 2\nparam tile = 2m\nmaterial brick color #804020 texture \"brick.png\" (tile, 50cm) normals "
        "\"bump.png\" "
        "rough \"rough.png\"\nterminal wall = cube\nstart S -> wall of brick\n");
    const Material& m = c.material("wall");
    EXPECT_EQ(m.name, "brick");
    ASSERT_TRUE(m.texture);
    EXPECT_EQ(m.texture->color->path, "/pictures/brick.png");
    EXPECT_EQ(m.texture->normals->path, "/pictures/bump.png");
    EXPECT_EQ(m.texture->roughness->path, "/pictures/rough.png");
    EXPECT_FLOAT_EQ(m.texture->width_m, 2);
    EXPECT_FLOAT_EQ(m.texture->height_m, .5f);
    EXPECT_FLOAT_EQ(m.roughness, Material().roughness) << "a picture leaves the number as it is";
}

TEST(Textures, ATileIsAsWideAsSaidAndKeepsItsShape) {
    const Covered c(
        "grammar 2\nterminal a = cube texture \"brick.png\"\nterminal b = cube texture \"brick.png\" 3m\n"
        "start S -> a + b at +y\n");
    EXPECT_FLOAT_EQ(c.material("a").texture->width_m, 1);
    EXPECT_FLOAT_EQ(c.material("a").texture->height_m, .5f);
    EXPECT_FLOAT_EQ(c.material("b").texture->width_m, 3);
    EXPECT_FLOAT_EQ(c.material("b").texture->height_m, 1.5f);
}

TEST(Textures, OneLookIsOneMaterial) {
    const Covered c(
        "grammar 2\nterminal a = cube color #ffffff\nstart S -> a texture \"brick.png\" 1m + a texture \"brick.png\" "
        "1m at +y "
        "+ a texture \"brick.png\" 2m at +x + a at -x\n");
    EXPECT_EQ(c.model->provenance.materials.size(), 3u);
}

TEST(Textures, AnotherMaterialTakesThemOff) {
    const Covered c(
        "grammar 2\nmaterial plain color #ffffff\nterminal a = cube texture \"brick.png\"\nterminal b = cube\n"
        "start S -> a of plain + b texture \"brick.png\" at +y\n");
    EXPECT_FALSE(c.material("a").texture);
    EXPECT_TRUE(c.material("b").texture);
}

TEST(Textures, PartsKnowWhetherTheirFacesAreFlat) {
    const Covered c("grammar 2\nterminal box = cube\nterminal ball = sphere\nstart S -> box + ball at +y\n");
    for (const Part& part : c.model->provenance.parts)
        if (part.symbol() == "box" || part.symbol() == "ball") {
            EXPECT_EQ(part.hasFlatFaces, part.symbol() == "box");
        }
}

TEST(Textures, OfShapesThatAreLaidRunOnAroundTheirOutline) {
    const Covered c(
        "grammar 2\nterminal wall = block texture \"brick.png\"\nterminal bare = cube color #ffffff\n"
        "start S -> footprint ell(9m, 8m, 3m, 2m) extrude 6m lay split y { 2m: wall | ~1: Upper }\n"
        "rule Upper -> wall + bare at +y\n");
    std::set<std::shared_ptr<const image::TextureFrame>> frames;
    for (const Part& part : c.model->provenance.parts) {
        if (part.symbol() == "wall") frames.insert(part.textureFrame);
        if (part.symbol() == "bare") {
            EXPECT_EQ(part.textureFrame, nullptr);
        }
    }
    ASSERT_EQ(frames.size(), 1u) << "one for all storeys";
    const image::TextureFrame& frame = **frames.begin();
    ASSERT_EQ(frame.sides.size(), 6u);
    EXPECT_NEAR(frame.size_m.y, 6, 1e-9);
    for (size_t i = 0; i < 6; ++i) {
        const image::TextureSide &side = frame.sides[i], &next = frame.sides[(i + 1) % 6];
        const Vec3d end = side.from + side.along * side.length_m;
        EXPECT_NEAR(length(end - next.from), 0, 1e-9) << "the next side begins where this one ends";
        EXPECT_NEAR(side.round_m, 34, 1e-9);
        if (i < 5) {
            EXPECT_NEAR(side.begin_m + side.length_m, next.begin_m, 1e-9);
        }
        const Vec3d normal = cross(Vec3d{0, 1, 0}, side.along) * -1.0;
        const auto map = image::mapFace(&frame, frame.axes, nullptr, true, frame.axes * normal,
                                        frame.origin + frame.axes * (side.from + side.along * (side.length_m / 2)));
        EXPECT_NEAR(dot(frame.origin + frame.axes * side.from, map.u) - map.begin_m[0], side.begin_m, 1e-9) << i;
    }
}

TEST(Textures, TilesThatFitFillTheirOwnScopeWhereNothingIsLaid) {
    const Covered c(
        "grammar 2\nstart S -> cube size 3m texture \"brick.png\" fitted + cube at +x texture \"brick.png\"\n");
    size_t fitting = 0;
    for (const Part& part : c.model->provenance.parts) {
        const auto& texture = c.model->provenance.materials[part.material].texture;
        if (!texture) continue;
        EXPECT_EQ(part.textureFrame != nullptr, texture->fits);
        fitting += texture->fits ? 1 : 0;
    }
    EXPECT_GT(fitting, 0u);
}

TEST(Textures, WhatIsWrongIsToldWithItsPlace) {
    const auto told = [](const std::string& text) {
        std::string errors;
        textured("grammar 2\n" + text + "\n", &errors);
        return errors;
    };
    EXPECT_NE(told("start S -> cube texture \"none.png\"").find("can't use \"none.png\": No such file or directory"),
              std::string::npos);
    EXPECT_NE(told("start S -> cube texture 3m").find("'texture' needs the name of a file in quotes, found '3m'"),
              std::string::npos)
        << told("start S -> cube texture 3m");
    EXPECT_NE(told("start S -> cube normals .8").find("needs the name of a file in quotes"), std::string::npos);
    EXPECT_NE(told("start S -> cube texture \"brick.png\" 30deg").find("one or two lengths"), std::string::npos);
    for (const char* tile : {"30%", "(1m, 2m, 3m)", "(1m, 30deg)", "true"})
        EXPECT_NE(told(std::string("start S -> cube texture \"brick.png\" ") + tile).find("one or two lengths"),
                  std::string::npos)
            << tile;
    for (const char* tile : {"0m", "(1m, 0m)"}) {
        const auto d = derive::derive(
            textured(std::string("grammar 2\nstart S -> cube texture \"brick.png\" ") + tile + "\n"), {}, nullptr);
        ASSERT_FALSE(d.ok()) << tile;
        EXPECT_NE(d.error().message.find("the tile of a texture is .1mm"), std::string::npos) << d.error().message;
        EXPECT_NE(d.error().message.find("test.sgm:2:"), std::string::npos) << d.error().message;
    }
}

}  // namespace
}  // namespace sgm::testing_
